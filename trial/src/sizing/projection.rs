//! What the 18 terms take of a series.

use nalgebra::{DMatrix, DVector};

use super::background::without_background;
use crate::world::{World, terms};

/// Added to each squared length, so that terms that say the same do no harm.
const RIDGE: f64 = 1e-10;

/// The 18 terms at the rows, without their slow part.
pub(crate) fn term_columns(world: &World) -> Vec<Vec<f64>> {
    let rows: Vec<[f64; 18]> =
        world.directions().iter().zip(world.rates()).map(|(&direction, rate)| terms(direction, rate)).collect();
    (0..18).map(|k| without_background(&rows.iter().map(|row| row[k]).collect::<Vec<f64>>())).collect()
}

/// What of a series no column takes; the columns have unit length.
pub(crate) fn beside(series: &[f64], columns: &[Vec<f64>]) -> Vec<f64> {
    let all = DMatrix::from_fn(series.len(), columns.len(), |row, column| columns[column][row]);
    let series = DVector::from_column_slice(series);
    let mut gram = all.tr_mul(&all);
    (0..columns.len()).for_each(|k| gram[(k, k)] += RIDGE);
    let Some(factor) = gram.cholesky() else { return vec![0.0; series.len()] };
    let taken = factor.solve(&all.tr_mul(&series));
    (series - all * taken).as_slice().to_vec()
}

/// Root of the sum of the squares.
pub(super) fn length(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The same with length 1.
pub(crate) fn unit(values: Vec<f64>) -> Vec<f64> {
    let length = length(&values).max(1e-300);
    values.into_iter().map(|value| value / length).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_no_column_takes_counts() {
        let columns = [vec![1.0, 0.0, 0.0], vec![0.6, 0.8, 0.0]];
        assert!((length(&beside(&[3.0, 4.0, 5.0], &columns)) - 5.0).abs() < 1e-6);
    }
}
