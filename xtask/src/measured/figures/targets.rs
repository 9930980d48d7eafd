//! What each method leaves of the flights, and keeps of targets that are added to them.

use anyhow::{Context, Result};
use serde_json::Value;

use crate::measured::markdown::{Table, list, number, word};
use crate::measured::tools::{Tools, flights, text};

/// Fluxgate, scalar calibrated with, scalar surveyed with.
const COMBINATIONS: [(&str, u32, u32); 8] =
    [("b", 5, 5), ("c", 4, 4), ("b", 4, 4), ("c", 5, 5), ("c", 5, 4), ("c", 4, 5), ("b", 5, 4), ("b", 4, 5)];

const METHODS: [&str; 4] = ["fixed", "rls", "saddle-point", "adaptive"];

pub(super) fn measure(tools: &Tools) -> Result<String> {
    let mut columns = vec!["fluxgate, scalar", "bound"];
    columns.extend(METHODS);
    columns.extend(["strong kept", "distortion", "`compensated_nT`"]);
    let mut table = Table::new(&columns);
    for combination in COMBINATIONS {
        table.row(&row(tools, combination)?);
    }
    Ok(table.into_text())
}

fn row(tools: &Tools, (fluxgate, calibrated, surveyed): (&str, u32, u32)) -> Result<Vec<String>> {
    let folder = flights().context("no flight recordings")?;
    let file = |scalar, part: &str| folder.join(format!("flux_{fluxgate}_mag_{scalar}_{part}.csv"));
    let (calibration, survey) = (file(calibrated, "calibration"), file(surveyed, "survey"));
    // With the sensor moved, from two minutes after the start of the box on.
    let skip_s = if calibrated == surveyed { "0" } else { "120" };
    let arguments =
        ["compare", text(&calibration)?, text(&survey)?, "--anomalies", "8", "--line", "box2", "--skip-s", skip_s];
    let result = tools.host_sim_json(&arguments, "summary.json")?;
    let detection = list(&result, "detection")?.first().context("no anomalies")?;
    let of = |method: &str| {
        let found = list(detection, "methods")?.iter().find(|of| of["method"] == method);
        found.with_context(|| format!("no {method}"))
    };
    let mut cells = vec![
        format!("{}, {calibrated} -> {surveyed}", fluxgate.to_uppercase()),
        format!("{:.3} nT", number(detection, "bound_nT")?),
    ];
    for method in METHODS {
        cells.push(residual_and_kept(of(method)?)?);
    }
    let adaptive = of("adaptive")?;
    cells.push(adaptive["kept_strong"].as_f64().map_or("-".into(), |kept| format!("{kept:.3}")));
    cells.push(format!("{:.3}", number(adaptive, "distortion")?));
    cells.push(format!("{:.2}", number(adaptive, "end_to_end_over_bound")?));
    Ok(cells)
}

fn residual_and_kept(of: &Value) -> Result<String> {
    let both = format!("{:.3} / {:.3}", number(of, "residual_over_bound")?, number(of, "kept")?);
    Ok(if word(of, "method")? == "adaptive" { format!("**{both}**") } else { both })
}
