//! What is left, drawn over what drives it and one thing beside: means of cells, each with its 95 % band.

use super::axes::label;
use super::curve::mean;
use super::drawn::{Drawn, Row, edges, part_of};
use crate::diagnosis::result::Map;
use crate::diagnosis::shapes::expression::Expr;

/// Parts along the driver, and along what is beside it.
pub(super) const PARTS: [usize; 2] = [12, 8];
/// Rows that a cell needs to have a mean.
const LEAST_ROWS: usize = 10;

/// Of cells between quantiles of both axes; those with few rows stay empty.
pub(super) fn map(drawn: &Drawn<'_>, over: [&Expr; 2]) -> Option<Map> {
    let [first, second] = [drawn.rows(over[0])?, drawn.rows(over[1])?];
    let inner = [edges(&first, PARTS[0]), edges(&second, PARTS[1])];
    let [columns, lines] = [inner[0].len() + 1, inner[1].len() + 1];
    let mut cells: Vec<Vec<Row>> = vec![Vec::new(); columns * lines];
    for (row, beside) in first.iter().zip(&second) {
        cells[part_of(&inner[1], beside.along) * columns + part_of(&inner[0], row.along)].push(*row);
    }
    let point = |cell: &Vec<Row>| (cell.len() >= LEAST_ROWS).then(|| mean(cell, drawn.form, drawn.level_nt));
    let cells = cells.chunks(columns).map(|line| line.iter().map(point).collect()).collect();
    Some(Map { over: over.map(label), edges: [with_ends(&inner[0], &first), with_ends(&inner[1], &second)], cells })
}

/// The inner edges, and the ends of the range.
fn with_ends(inner: &[f64], rows: &[Row]) -> Vec<f64> {
    let along = || rows.iter().map(|row| row.along);
    let (low, high) = (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max));
    std::iter::once(low).chain(inner.iter().copied()).chain([high]).collect()
}
