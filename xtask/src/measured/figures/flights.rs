//! The real flights against the f64 reference, as their test prints them.

use anyhow::{Result, ensure};

use crate::measured::markdown::Table;
use crate::measured::tools::{Tools, test_lines};

pub(super) fn measure(_: &Tools) -> Result<String> {
    let lines = test_lines("host-sim", "host", "flight_recordings::residuals")?;
    let mut table = Table::new(&["fluxgate, scalar", "before", "fixed", "rls", "saddle-point"]);
    let mut rows = 0;
    for line in lines.iter().filter(|line| line.contains(" -> ")) {
        // `b 5 -> 5:   12.098  +0.0 %    0.708  +1.8 %` and so on.
        let Some((combination, figures)) = line.split_once(':') else { continue };
        let words: Vec<&str> = figures.split_whitespace().filter(|word| *word != "%").collect();
        ensure!(words.len() == 8, "four figures and four distances are expected: {line}");
        let mut cells = vec![combination.to_uppercase().replacen(' ', ", ", 1), words[0].to_string()];
        cells.extend(words[2..].chunks(2).map(|pair| format!("{} ({} %)", pair[0], pair[1])));
        table.row(&cells);
        rows += 1;
    }
    ensure!(rows > 0, "the test has printed no figures");
    Ok(table.into_text())
}
