//! The paper's Table 1, simulated.

use anyhow::Result;
use serde_json::Value;

use crate::measured::markdown::{Table, list, number, three_digits, word};
use crate::measured::tools::Tools;

/// Scenario, its name here, and the published method's ratio in the paper's experiment.
const TOWS: [(&str, &str, &str); 2] =
    [("sea_tow.toml", "sea, 3.936 nT", "9.08"), ("lake_tow.toml", "lake, 14.07 nT", "6.76")];

pub(super) fn measure(tools: &Tools) -> Result<String> {
    let scenarios = ["scenarios/land_calibration.toml", "scenarios/sea_tow.toml", "scenarios/lake_tow.toml"];
    let result = tools.host_sim_json(&[&["table"][..], &scenarios].concat(), "table.json")?;
    let methods = ["none", "fixed", "rls", "saddle-point", "adaptive"];
    let mut table =
        Table::new(&[&[""][..], &methods, &["best in hindsight", "published method in the paper"]].concat());
    for tow in list(&result, "tows")? {
        let scenario = word(tow, "scenario")?;
        let (_, name, in_paper) = TOWS.into_iter().find(|tow| tow.0 == scenario).unwrap_or((scenario, scenario, "-"));
        let mut cells = vec![name.to_string()];
        for (whole, late) in list(tow, "whole")?.iter().zip(list(tow, "late")?) {
            cells.push(format!("{} / {}", ratio(whole)?, ratio(late)?));
        }
        cells.push(three_digits(number(tow, "late_bound_improvement_ratio")?));
        cells.push(in_paper.to_string());
        table.row(&cells);
    }
    Ok(table.into_text())
}

fn ratio(entry: &Value) -> Result<String> {
    Ok(three_digits(number(entry, "improvement_ratio")?))
}
