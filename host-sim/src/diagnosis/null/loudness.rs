//! Whether the noise is louder the more the body moves, or where it points.

use super::finding::Finding;
use super::squares::{Squares, centred};
use crate::diagnosis::noise::motion::slope_and_bend;
use crate::diagnosis::regression::problem::{RegressionProblem, solve};
use crate::diagnosis::search::log_tail;
use crate::simulator::signals::Signals;

/// The squares of a residual `z` of variance 1, fitted by what the motion is at each row (the score test of Breusch and Pagan, 1979,
/// with the spread that the squares have, after Koenker, 1981); the noise model may have its variance wrong by `allowed`, as a share
/// of it.
pub(super) fn loudness(problem: &RegressionProblem<'_>, z: &[f64], allowed: f64) -> Finding {
    let n = z.len() as f64;
    let rows: Vec<usize> = problem.whitening.rows().collect();
    let on_samples = |column: &Vec<f64>| centred(rows.iter().map(|&row| column[row]).collect()).1;
    let columns: Vec<Vec<f64>> = columns(&problem.signals).iter().map(on_samples).collect();
    let Squares { centred: squares, spread, .. } = Squares::of(z);
    let (explained, _, rank) = solve(&columns, &squares);
    if rank == 0 || spread <= 0.0 {
        return Finding { what: "loudness", log_p: 0.0, excess: 0.0 };
    }
    // Chi-squared with the mean and the variance of the one that what the model has wrong makes of it.
    let (dof, by_model) = (rank as f64, n * allowed * allowed / spread);
    let scale = (dof + 2.0 * by_model) / (dof + by_model);
    let log_p = log_tail((dof + by_model) / scale, explained / spread / scale);
    Finding { what: "loudness", log_p, excess: 0.5 * (n * (explained - dof * spread).max(0.0)).sqrt() }
}

/// Direction and its squares, squares of its rate, of the reading's slope and of its bend.
fn columns(signals: &Signals) -> Vec<Vec<f64>> {
    let rows = signals.rows();
    let mut columns: Vec<Vec<f64>> = (0..3).map(|i| rows.direction.iter().map(|c| c[i]).collect()).collect();
    for (i, j) in [(0, 0), (1, 1), (0, 1), (0, 2), (1, 2)] {
        columns.push(rows.direction.iter().map(|c| c[i] * c[j]).collect());
    }
    columns.extend((0..3).map(|i| rows.direction_rate.iter().map(|rate| rate[i] * rate[i]).collect()));
    columns.extend(slope_and_bend(signals).map(|column| column.iter().map(|x| x * x).collect()));
    columns
}
