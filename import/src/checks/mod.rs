//! Physics at the door: what cannot be, what is likely otherwise, and the option that mends it.

mod axes;
mod earth;
mod heading;
mod lag;
mod magnitude;
mod statistics;
mod stuck;

pub(crate) use self::magnitude::settle_units;
pub use self::stuck::standing_still;

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
