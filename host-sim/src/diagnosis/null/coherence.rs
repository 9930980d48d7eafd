//! Whether the residual of a window follows the motion of that window more than it follows that of others: what is driven by
//! the motion does, in whatever way, and however much of it was taken for noise.

use std::ops::Range;

use super::omnibus::Finding;
use crate::diagnosis::noise::motion::local_columns;
use crate::diagnosis::policy::{COHERENCE_LEAST_WINDOWS, COHERENCE_WINDOWS};
use crate::diagnosis::regression::problem::RegressionProblem;
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::search::log_tail;

/// Windows that a window's motion is held against, at most: evenly spread over the recording.
const MOST_OTHERS: usize = 40;

/// Of a whitened residual of variance 1.
pub(super) fn coherence(problem: &RegressionProblem<'_>, z: &[f64]) -> Finding {
    let columns: Vec<Vec<f64>> =
        local_columns(&problem.signals).iter().map(|column| problem.whitening.apply(column)).collect();
    let of_length = |&samples: &usize| of_windows(&windows(&problem.whitening.ranges(), samples), &columns, z);
    let best = COHERENCE_WINDOWS.iter().map(of_length).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0.0));
    let (log_p, excess) = (best.0 + (COHERENCE_WINDOWS.len() as f64).ln(), best.1);
    Finding { what: "motion", log_p: log_p.min(0.0), excess }
}

/// Windows of equal length within the blocks.
fn windows(blocks: &[Range<usize>], samples: usize) -> Vec<Range<usize>> {
    let of = |block: &Range<usize>| {
        let first = block.start;
        (0..block.len() / samples).map(move |k| first + k * samples..first + (k + 1) * samples)
    };
    blocks.iter().flat_map(of).collect()
}

/// Logarithm of the chance, and the power beyond it.
fn of_windows(windows: &[Range<usize>], columns: &[Vec<f64>], z: &[f64]) -> (f64, f64) {
    let count = windows.len();
    if count < COHERENCE_LEAST_WINDOWS {
        return (0.0, 0.0);
    }
    let part = |window: &Range<usize>| {
        Projection::of(&columns.iter().map(|column| column[window.clone()].to_vec()).collect::<Vec<_>>())
    };
    let motions: Vec<Projection> = windows.iter().map(part).collect();
    let power = |window: usize, motion: usize| motions[motion].components(&z[windows[window].clone()]).norm_squared();
    let others = MOST_OTHERS.min(count - 1);
    let (mut own, mut expected, mut variance) = (0.0, 0.0, 0.0);
    for window in 0..count {
        let of_others: Vec<f64> =
            (0..others).map(|k| power(window, (window + 1 + k * (count - 1) / others) % count)).collect();
        let (mean, spread) = mean_and_variance(&of_others);
        own += power(window, window);
        expected += mean;
        variance += spread;
    }
    let scale = 0.5 * variance / expected.max(f64::MIN_POSITIVE);
    (log_tail(expected / scale, own / scale), own - expected)
}

fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0))
}
