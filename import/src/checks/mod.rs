//! Physics at the door: what cannot be, what is likely otherwise, and the option that mends it.

mod axes;
mod earth;
mod heading;
mod lag;
mod magnitude;
mod stuck;

pub(crate) use self::magnitude::settle_units;

use crate::draft::Draft;
use crate::finding::Finding;

/// All that can be said of a recording at 10 Hz whose columns have their units.
pub(crate) fn check(draft: &Draft) -> Vec<Finding> {
    let mut findings = stuck::check(draft);
    let swapped = magnitude::check(draft);
    // With readings in each other's place nothing below means anything.
    if !findings.is_empty() || swapped.is_some() {
        findings.extend(swapped);
        return findings;
    }
    findings.extend(earth::check(draft));
    findings.extend(axes::check(draft));
    findings.extend(lag::check(draft));
    findings
}

/// Rows whose scalar and fluxgate may be used.
fn usable(draft: &Draft, scalar: &[f64], flux: &[&[f64]; 3]) -> Vec<usize> {
    (0..draft.len())
        .filter(|&row| !draft.invalid[row] && scalar[row].is_finite() && flux.iter().all(|axis| axis[row].is_finite()))
        .collect()
}

/// Mean and standard deviation.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|value| value.is_finite());
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
