//! The table that a part ends with: what, asked, measured, of what.

/// One line of a table, and whether it is what was asked.
pub(crate) struct Figure {
    what: String,
    asked: String,
    measured: String,
    of: String,
    is_reached: bool,
}

impl Figure {
    /// A figure with bounds; not a number is never reached. Bounds that are infinite ask for nothing.
    pub(crate) fn new(what: impl Into<String>, [value, low, high]: [f64; 3], of: impl Into<String>) -> Self {
        let asked = match (low.is_finite(), high.is_finite()) {
            (false, false) => "-".into(),
            (true, false) => format!("at least {}", short(low)),
            (false, true) => format!("at most {}", short(high)),
            (true, true) => format!("{} to {}", short(low), short(high)),
        };
        let is_free = !low.is_finite() && !high.is_finite();
        let is_reached = is_free || (low..=high).contains(&value);
        Self { what: what.into(), asked, measured: format!("{value:.3}"), of: of.into(), is_reached }
    }
}

/// Without the digits that multiplying leaves.
fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Ask for nothing.
pub(crate) const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Print it in the form of docs/measured.md; all that was asked must be reached.
pub(crate) fn finish(title: &str, figures: &[Figure]) {
    println!("\n{title}\n\n| | asked | measured | |\n|---|---|---|---|");
    for Figure { what, asked, measured, of, is_reached } in figures {
        println!("| {what} | {asked} | {}{measured} | {of} |", if *is_reached { "" } else { "**missed** " });
    }
    let missed = figures.iter().filter(|figure| !figure.is_reached).count();
    assert_eq!(missed, 0, "{missed} figures are not what was asked for");
}
