//! Epochs and rows a second, as `cargo bench` measures them.

use anyhow::{Context, Result};
use serde_json::Value;

use crate::measured::markdown::{Table, thousands};
use crate::measured::tools::{Tools, cargo, processor};
use crate::repository;

/// Group and name of each benchmark, and what it measures.
const ROWS: [(&str, &str, &str); 6] = [
    ("core", "fixed", "core, `fixed`: epochs a second"),
    ("core", "rls", "core, `rls`"),
    ("core", "saddle-point", "core, `saddle-point`"),
    ("core", "adaptive", "core, `adaptive`"),
    ("core", "f64 direct solve of eq. (16)", "eq. (16) alone, solved directly in f64 each epoch"),
    ("replay", "CSV to CSV and report, adaptive", "`replay`, CSV to CSV and report, `adaptive`: rows a second"),
];

pub(super) fn measure(_: &Tools) -> Result<String> {
    cargo(&["bench", "--quiet", "-p", "host-sim", "--bench", "throughput"])?;
    let mut table = Table::new(&["one core", "a second"]);
    for (group, name, what) in ROWS {
        table.row(&[what, &thousands(rate(group, name)?)]);
    }
    Ok(format!("{}\nOn: {}.\n", table.into_text(), processor()))
}

/// Elements a second, from the files that criterion leaves.
fn rate(group: &str, name: &str) -> Result<f64> {
    // Criterion makes a folder name of what a file system may refuse.
    let folder = name.replace(['?', '"', '/', '\\', '*', '<', '>', ':', '|', '^'], "_");
    let folder = repository::target_folder().join("criterion").join(group).join(folder).join("new");
    let read = |file: &str| -> Result<Value> {
        let path = folder.join(file);
        Ok(serde_json::from_slice(&std::fs::read(&path).with_context(|| path.display().to_string())?)?)
    };
    let time_ns = read("estimates.json")?["mean"]["point_estimate"].as_f64().context("no estimate")?;
    let elements = read("benchmark.json")?["throughput"]["Elements"].as_f64().context("no count of elements")?;
    Ok(elements / time_ns * 1e9)
}
