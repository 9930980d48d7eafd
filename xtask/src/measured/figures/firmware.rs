//! Instructions, flash and memory of the firmware, as the emulation's tests print them.

use std::collections::BTreeMap;

use anyhow::{Context, Result};

use crate::measured::markdown::{Table, grouped};
use crate::measured::tools::{Tools, cargo, test_lines};

/// Name in `firmware/figures.toml`, and what it is.
const ROWS: [(&str, &str); 7] = [
    ("instructions_per_epoch_mean", "instructions of an epoch, `saddle-point`, one conversion: mean"),
    ("instructions_per_epoch_worst", "the same: worst epoch"),
    (
        "instructions_per_epoch_mean_of_25_conversions",
        "with the 25 conversions of the board, leak contact and battery, over three minutes: mean",
    ),
    ("adaptive_instructions_per_epoch_mean", "`adaptive`, one conversion: mean"),
    ("adaptive_instructions_per_epoch_worst", "the same: worst epoch"),
    ("flash_bytes", "flash of the board's image, bytes"),
    ("ram_and_stack_bytes", "statics and deepest stack, `adaptive`, emulated image, bytes"),
];

pub(super) fn measure(_: &Tools) -> Result<String> {
    cargo(&["fw", "--quiet"])?;
    cargo(&["fw-emu", "--quiet"])?;
    let mut measured: BTreeMap<String, [String; 2]> = BTreeMap::new();
    for line in
        test_lines("host-sim", "host", "its_figures")?.iter().chain(&test_lines("host-sim", "host", "and_dearer")?)
    {
        // `flash_bytes 162411 (limit 163000)`
        if let Some((name, value, limit)) = parsed(line) {
            let largest = measured.get(name).map_or(value, |[known, _]| value.max(known.parse().unwrap_or(0.0)));
            measured.insert(name.to_string(), [largest.to_string(), grouped(limit)]);
        }
    }
    let mut table = Table::new(&["", "measured", "limit"]);
    for (name, what) in ROWS {
        let [value, limit] = measured.get(name).with_context(|| format!("the tests have not printed {name}"))?;
        table.row(&[what, &grouped(value.parse()?), limit]);
    }
    Ok(table.into_text())
}

fn parsed(line: &str) -> Option<(&str, f64, f64)> {
    let (name, rest) = line.split_once(' ')?;
    let (value, limit) = rest.split_once(" (limit ")?;
    Some((name, value.parse().ok()?, limit.trim_end_matches(')').parse().ok()?))
}
