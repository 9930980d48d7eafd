//! What the first command of the README prints.

use anyhow::Result;

use crate::measured::tools::{Tools, text};

pub(super) fn measure(tools: &Tools) -> Result<String> {
    let out = tools.path("sample");
    let printed = tools.host_sim(&["compare", "sample/calibration.csv", "sample/survey.csv", "--out", text(&out)?])?;
    Ok(format!("```\n{}\n```\n", printed.trim_end()))
}
