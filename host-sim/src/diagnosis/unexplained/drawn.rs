//! What is left of a recording, ready to be drawn: its rows along an axis, in parts with equally many.

use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::Expr;
use crate::diagnosis::shapes::scene::Scene;

/// A row of the recording: what is left and what is fitted, nT, and where it is along an axis.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub(super) left_nt: f64,
    pub(super) fitted_nt: f64,
    pub(super) along: f64,
}

/// What is left, and what is fitted to it, nT, one value a row; and how it enters.
pub(super) struct Drawn<'b> {
    pub(super) left_nt: &'b [Option<f64>],
    pub(super) fitted_nt: &'b [Option<f64>],
    pub(super) form: DriverForm,
    pub(super) scene: &'b Scene,
    /// Mean of what is fitted.
    pub(super) level_nt: f64,
}

impl<'b> Drawn<'b> {
    pub(super) fn new(
        left_nt: &'b [Option<f64>],
        fitted_nt: &'b [Option<f64>],
        form: DriverForm,
        scene: &'b Scene,
    ) -> Self {
        let used = || left_nt.iter().zip(fitted_nt).filter_map(|(left, fitted)| left.and(*fitted));
        let level_nt = used().sum::<f64>() / used().count().max(1) as f64;
        Self { left_nt, fitted_nt, form, scene, level_nt }
    }

    /// The rows that are used along an axis; none where the recording has not what it needs.
    pub(super) fn rows(&self, over: &Expr) -> Option<Vec<Row>> {
        let along = over.evaluate(self.scene)?;
        let of = |row: usize| {
            let fitted_nt = self.fitted_nt.get(row).copied().flatten().unwrap_or(0.0);
            Some(Row { left_nt: self.left_nt[row]?, fitted_nt, along: along[row] })
        };
        Some((0..along.len()).filter_map(of).collect())
    }
}

/// Inner edges of parts with equally many rows, ascending.
pub(super) fn edges(rows: &[Row], parts: usize) -> Vec<f64> {
    let mut along: Vec<f64> = rows.iter().map(|row| row.along).collect();
    along.sort_by(f64::total_cmp);
    let mut edges: Vec<f64> = (1..parts).map(|k| along[k * along.len() / parts]).collect();
    edges.dedup();
    edges
}

/// The part in which a value is.
pub(super) fn part_of(edges: &[f64], along: f64) -> usize {
    edges.partition_point(|edge| *edge <= along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_hold_equally_many_rows_and_those_alike_are_not_split() {
        let row = |along: f64| Row { left_nt: 0.0, fitted_nt: 0.0, along };
        let spread: Vec<Row> = (0..90).map(|k| row(f64::from(k))).collect();
        assert_eq!(edges(&spread, 3), [30.0, 60.0]);
        assert_eq!([29.0, 30.0, 89.0].map(|along| part_of(&[30.0, 60.0], along)), [0, 1, 2]);
        let switch: Vec<Row> = (0..90).map(|k| row(f64::from(k / 45))).collect();
        assert_eq!(edges(&switch, 6), [0.0, 1.0]);
    }
}
