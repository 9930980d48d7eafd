//! The background: what is slower than a period, over gaps too.

use std::f64::consts::TAU;
use std::ops::Range;

/// The slow part of values, by penalised least squares on their second differences (Whittaker, On a new method of
/// graduation, Proc. Edinburgh Math. Soc. 41, 1923): a low-pass without delay, of half the amplitude at `period_rows`.
/// `weights` are zero where a value does not count. None counts: zeros.
fn slow_part(values: &[f64], weights: &[f64], period_rows: f64) -> Vec<f64> {
    let penalty = (TAU / period_rows).powi(-4);
    let len = values.len();
    if weights.iter().filter(|weight| **weight > 0.0).count() < 2 {
        return vec![0.0; len];
    }
    let value = |row: usize| if weights[row] > 0.0 { weights[row] * values[row] } else { 0.0 };
    // L D L^T of the pentadiagonal matrix: a diagonal and two rows below it.
    let (mut diagonal, mut first, mut second) = (vec![0.0; len], vec![0.0; len], vec![0.0; len]);
    let mut solution = vec![0.0; len];
    for row in 0..len {
        let [a, b, c] = penalty_of(row, len).map(|cell| penalty * cell);
        let [one, two] = [1, 2].map(|back| row.checked_sub(back));
        let two_back = two.map_or(0.0, |at| c / diagonal[at]);
        let one_back =
            one.map_or(0.0, |at| (b - two_back * diagonal_of(two, &diagonal) * below(two, &first)) / diagonal[at]);
        diagonal[row] = weights[row] + a
            - one.map_or(0.0, |at| one_back * one_back * diagonal[at])
            - two.map_or(0.0, |at| two_back * two_back * diagonal[at]);
        if let Some(at) = one {
            first[at] = one_back;
        }
        if let Some(at) = two {
            second[at] = two_back;
        }
        solution[row] =
            value(row) - one.map_or(0.0, |at| one_back * solution[at]) - two.map_or(0.0, |at| two_back * solution[at]);
    }
    for row in (0..len).rev() {
        let later = |by: usize, below: &[f64]| if row + by < len { below[row] * solution[row + by] } else { 0.0 };
        let taken = later(1, &first) + later(2, &second);
        solution[row] = solution[row] / diagonal[row] - taken;
    }
    solution
}

fn diagonal_of(at: Option<usize>, diagonal: &[f64]) -> f64 {
    at.map_or(0.0, |at| diagonal[at])
}

fn below(at: Option<usize>, first: &[f64]) -> f64 {
    at.map_or(0.0, |at| first[at])
}

/// Diagonal, first and second neighbour to the left of the product of second differences.
fn penalty_of(row: usize, len: usize) -> [f64; 3] {
    let differences = |row: usize| if row + 2 < len { 1.0 } else { 0.0 };
    // Second difference k is x[k] - 2 x[k + 1] + x[k + 2].
    let own = differences(row);
    let as_middle = if row >= 1 { differences(row - 1) } else { 0.0 };
    let as_last = if row >= 2 { differences(row - 2) } else { 0.0 };
    [own + 4.0 * as_middle + as_last, -2.0 * as_middle - 2.0 * as_last, as_last]
}

/// The slow part of each of these parts alone.
pub(crate) fn slow_part_by(parts: &[Range<usize>], values: &[f64], weights: &[f64], period_rows: f64) -> Vec<f64> {
    let mut slow = vec![0.0; values.len()];
    for part in parts {
        let of_part = slow_part(&values[part.clone()], &weights[part.clone()], period_rows);
        slow[part.clone()].copy_from_slice(&of_part);
    }
    slow
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dense(values: &[f64], weights: &[f64], period_rows: f64) -> Vec<f64> {
        let len = values.len();
        let penalty = (TAU / period_rows).powi(-4);
        let mut matrix = nalgebra::DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(weights));
        for k in 0..len - 2 {
            for (i, a) in [1.0, -2.0, 1.0].iter().enumerate() {
                for (j, b) in [1.0, -2.0, 1.0].iter().enumerate() {
                    matrix[(k + i, k + j)] += penalty * a * b;
                }
            }
        }
        let right = nalgebra::DVector::from_fn(len, |k, _| weights[k] * values[k]);
        matrix.lu().solve(&right).unwrap().iter().copied().collect()
    }

    #[test]
    fn it_is_the_solution_of_the_whole_system() {
        let values: Vec<f64> = (0..40).map(|k| (k as f64 * 0.7).sin() + 0.1 * k as f64).collect();
        let mut weights = vec![1.0; 40];
        weights[10..17].fill(0.0);
        let (slow, exact) = (slow_part(&values, &weights, 12.0), dense(&values, &weights, 12.0));
        assert!(slow.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-9), "{slow:?} {exact:?}");
    }

    #[test]
    fn half_the_amplitude_is_left_at_the_period() {
        let wave: Vec<f64> = (0..4000).map(|k| (k as f64 * TAU / 100.0).sin()).collect();
        let slow = slow_part(&wave, &vec![1.0; 4000], 100.0);
        let left = slow[1000..3000].iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!((left - 0.5).abs() < 0.01, "{left}");
    }
}
