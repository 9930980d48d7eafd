//! The core in f32 against the equations in f64, as the test of a day prints it.

use anyhow::{Context, Result, ensure};

use crate::measured::markdown::Table;
use crate::measured::tools::{Tools, test_lines};

pub(super) fn measure(_: &Tools) -> Result<String> {
    let mut table = Table::new(&["", "24 hours", "first hour", "last hour"]);
    let mut rows = 0;
    for line in test_lines("host-sim-library", "core", "a_day")? {
        // `rls: difference of the residual 0.000089 nT rms over 24 h, first hour 0.000105, last 0.000084`
        let Some((name, figures)) = line.split_once(": difference of the residual ") else { continue };
        let numbers: Vec<&str> = figures.split([' ', ',']).filter(|word| word.contains('.')).collect();
        let name = if name.starts_with("elastic net") { "batch elastic net" } else { name };
        let number = |index: usize| numbers.get(index).copied().unwrap_or_default();
        number(0).parse::<f64>().with_context(|| line.clone())?;
        table.row(&[name, number(0), number(1), number(2)]);
        rows += 1;
    }
    ensure!(rows == 4, "the tests have printed {rows} figures, not four");
    Ok(table.into_text())
}
