//! What the 18 terms take of a series.

use nalgebra::{DMatrix, DVector};

use super::background::without_background;
use crate::world::{World, terms};

/// Added to each squared length, so that terms that say the same do no harm.
const RIDGE: f64 = 1e-10;

/// A column of a design matrix: zero but from a row on, for as many rows as there are values.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    start: usize,
    values: Vec<f64>,
}

impl Column {
    /// With length 1.
    pub(crate) fn unit(start: usize, values: Vec<f64>) -> Self {
        let length = length(&values).max(1e-300);
        Self { start, values: values.into_iter().map(|value| value / length).collect() }
    }

    fn along(&self, other: &Self) -> f64 {
        let from = self.start.max(other.start);
        self.from(from).zip(other.from(from)).map(|(a, b)| a * b).sum()
    }

    /// The values from a row on that is not before the first.
    fn from(&self, row: usize) -> impl Iterator<Item = &f64> {
        self.values.iter().skip(row - self.start)
    }
}

/// The 18 terms at the rows, without their slow part.
pub(crate) fn term_columns(world: &World) -> Vec<Vec<f64>> {
    let rows: Vec<[f64; 18]> =
        world.directions().iter().zip(world.rates()).map(|(&direction, rate)| terms(direction, rate)).collect();
    (0..18).map(|k| without_background(&rows.iter().map(|row| row[k]).collect::<Vec<f64>>())).collect()
}

/// What of a series no column takes; the columns have unit length.
pub(crate) fn beside(series: &[f64], columns: &[Column]) -> Vec<f64> {
    let count = columns.len();
    let mut gram = DMatrix::from_fn(count, count, |a, b| if a < b { 0.0 } else { columns[a].along(&columns[b]) });
    (0..count).for_each(|k| gram[(k, k)] += RIDGE);
    let whole = Column { start: 0, values: series.to_vec() };
    let along = DVector::from_fn(count, |k, _| columns[k].along(&whole));
    let Some(factor) = gram.cholesky() else { return vec![0.0; series.len()] };
    let mut rest = series.to_vec();
    for (column, taken) in columns.iter().zip(factor.solve(&along).iter()) {
        rest[column.start..].iter_mut().zip(&column.values).for_each(|(value, x)| *value -= taken * x);
    }
    rest
}

/// Root of the sum of the squares.
pub(super) fn length(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_no_column_takes_counts() {
        let columns = [Column::unit(0, vec![2.0, 0.0, 0.0]), Column::unit(0, vec![0.6, 0.8])];
        assert!((length(&beside(&[3.0, 4.0, 5.0], &columns)) - 5.0).abs() < 1e-6);
        let late = [Column::unit(1, vec![1.0, 1.0]), Column::unit(0, vec![1.0, 1.0])];
        // Across (1, 1, 0) and (0, 1, 1) lies (1, -1, 1).
        assert!((length(&beside(&[3.0, 4.0, 5.0], &late)) - 4.0 / 3.0_f64.sqrt()).abs() < 1e-6);
    }
}
