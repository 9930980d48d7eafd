//! A residual folded over a period: the best phase and duty of a pulse train.

use nalgebra::Vector3;

use super::residual::DirectedResidual;
use crate::diagnosis::policy::RATE_HZ;

/// Shares of a period that are tried first.
const DUTIES: [f64; 9] = [0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7];
/// Parts of a period that a fold tells apart, at least, and at most: with a few duties, and with every one.
const LEAST_BINS: usize = 4;
const BINS: usize = 100;
const FINE_BINS: usize = 300;
/// Duties of a period that are fitted.
const FITTED: usize = 2;
/// Periods on either side of one that are folded.
const PERIODS_BESIDE: i32 = 12;

/// A period with its best phase and duty.
pub(super) struct Fold {
    pub(super) glrt: f64,
    pub(super) period_s: f64,
    pub(super) duty: f64,
    pub(super) phase: f64,
}

/// The width of a pulse, bins, and the whitened power of a train of such pulses.
struct Shape {
    width: usize,
    power: f64,
}

/// The best folds of a few duties at a period, or so near to it that the ends of the recording move by less than a
/// row.
pub(super) fn best_near(residual: &DirectedResidual<'_>, period_s: f64) -> Vec<Fold> {
    let step = 0.1 * period_s / residual.duration_s();
    let bins = bins(period_s, BINS);
    let widths = DUTIES.map(|duty| (duty * bins as f64).round() as usize);
    let shapes = shapes(residual, period_s, bins, widths.into_iter().filter(|width| (1..bins).contains(width)));
    let mut best: Vec<Fold> = Vec::new();
    for k in -PERIODS_BESIDE..=PERIODS_BESIDE {
        let folds = folds(residual, period_s + 0.5 * f64::from(k) * step, bins, &shapes);
        if best.is_empty() {
            best = folds;
        } else {
            let better = best.iter_mut().zip(folds).filter(|(best, fold)| fold.glrt > best.glrt);
            better.for_each(|(best, fold)| *best = fold);
        }
    }
    first_few(best)
}

/// The best folds of all duties at a period.
pub(super) fn every_duty(residual: &DirectedResidual<'_>, period_s: f64) -> Vec<Fold> {
    let bins = bins(period_s, FINE_BINS);
    first_few(folds(residual, period_s, bins, &shapes(residual, period_s, bins, 1..=bins / 2)))
}

/// Parts of a period: rows, as far as may be.
fn bins(period_s: f64, most: usize) -> usize {
    ((period_s * RATE_HZ).round() as usize).clamp(LEAST_BINS, most)
}

fn shapes(
    residual: &DirectedResidual<'_>,
    period_s: f64,
    bins: usize,
    widths: impl Iterator<Item = usize>,
) -> Vec<Shape> {
    widths.map(|width| Shape { width, power: residual.power_of_pulses(period_s, width as f64 / bins as f64) }).collect()
}

/// The best phase of each shape at a period.
fn folds(residual: &DirectedResidual<'_>, period_s: f64, bins: usize, shapes: &[Shape]) -> Vec<Fold> {
    let sums = cumulative(&folded(residual, period_s, bins));
    let of_shape = |&Shape { width, power }: &Shape| {
        let glrt =
            |start: usize| residual.explained(Vector3::from_fn(|i, _| sums[start + width][i] - sums[start][i])) / power;
        let (start, glrt) =
            (0..bins).map(|start| (start, glrt(start))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        let phase = (1.0 - start as f64 / bins as f64).rem_euclid(1.0);
        Fold { glrt, period_s, duty: width as f64 / bins as f64, phase }
    };
    shapes.iter().map(of_shape).collect()
}

/// The residual summed up by its phase, in bins of a period; within a bin in the order of the rows.
fn folded(residual: &DirectedResidual<'_>, period_s: f64, bins: usize) -> Vec<[f64; 3]> {
    let mut folded = vec![[0.0; 3]; bins];
    for (row, time_s) in residual.rows.iter().zip(residual.epochs_s()) {
        let cycles = time_s / period_s;
        let bin = (((cycles - cycles.floor()) * bins as f64) as usize).min(bins - 1);
        (0..3).for_each(|i| folded[bin][i] += row[i]);
    }
    folded
}

/// Cumulative sums over two periods, so that a pulse may go on into the next one.
fn cumulative(folded: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; 2 * folded.len() + 1];
    for k in 0..2 * folded.len() {
        sums[k + 1] = [0, 1, 2].map(|i| sums[k][i] + folded[k % folded.len()][i]);
    }
    sums
}

/// The best folds of a period.
fn first_few(mut folds: Vec<Fold>) -> Vec<Fold> {
    folds.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    folds.truncate(FITTED);
    folds
}
