//! Intervals from draws of a share.

use crate::diagnosis::policy::BOOTSTRAP_DRAWS;

/// The 95 % interval of a share from draws of it, which holds the share itself.
pub(super) fn ci95(fraction: f64, drawn: impl FnMut() -> f64) -> [f64; 2] {
    let mut drawn: Vec<f64> = std::iter::repeat_with(drawn).take(BOOTSTRAP_DRAWS).collect();
    drawn.sort_by(f64::total_cmp);
    let tail = BOOTSTRAP_DRAWS / 40;
    [drawn[tail].min(fraction), drawn[BOOTSTRAP_DRAWS - 1 - tail].max(fraction)]
}
