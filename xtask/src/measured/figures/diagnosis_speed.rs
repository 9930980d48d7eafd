//! How long `diagnose` takes, reading and writing included.

use anyhow::{Result, ensure};

use crate::measured::markdown::{Table, three_digits};
use crate::measured::tools::{Tools, processor, text};
use crate::repository;

const SCENARIO: &str = "scenarios/lake_tow.toml";
const MINUTES: [u32; 4] = [5, 10, 20, 60];

pub(super) fn measure(tools: &Tools) -> Result<String> {
    let mut columns = vec!["elapsed, s".to_string()];
    columns.extend(MINUTES.map(|minutes| format!("{minutes} min")));
    let mut table = Table::new(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    let effects: [(&str, &[&str]); 2] =
        [("nothing to find", &[]), ("one effect", &["--effect", "scalar_lag:lag_s=0.02"])];
    for (what, effect) in effects {
        let mut cells = vec![what.to_string()];
        for minutes in MINUTES {
            cells.push(three_digits(elapsed_s(tools, minutes, effect)?));
        }
        table.row(&cells);
    }
    Ok(format!("{}\nOn: {}.\n", table.into_text(), processor()))
}

fn elapsed_s(tools: &Tools, minutes: u32, effect: &[&str]) -> Result<f64> {
    let preset = repository::text(SCENARIO).unwrap_or_default();
    ensure!(preset.contains("\nduration_s = "), "{SCENARIO} has no duration");
    let line = |line: &str| match line.starts_with("duration_s = ") {
        true => format!("duration_s = {}.0\n", 60 * minutes),
        false => format!("{line}\n"),
    };
    let longer: String = preset.lines().map(line).collect();
    let (scenario, recording, out) = (tools.path("tow.toml"), tools.path("tow.csv"), tools.path("diagnosed"));
    std::fs::write(&scenario, longer)?;
    tools.host_sim(&[&["simulate", text(&scenario)?, "--out", text(&recording)?], effect].concat())?;
    Ok(tools.shortest(&["diagnose", text(&recording)?, "--out", text(&out)?])?.as_secs_f64())
}
