//! What is left, drawn over what drives it: means of parts with equally many rows, each with its 95 % band.

use super::drawn::{Drawn, Row};
use crate::diagnosis::evidence::interval::TWO_SIGMA;
use crate::diagnosis::result::{CurvePoint, DriverForm};
use crate::diagnosis::shapes::expression::Expr;

/// Rows that are as good as one: neighbours are alike.
pub(super) const ROWS_ALIKE: f64 = 10.0;

/// The mean of some rows, with its 95 % band; of noise, its standard deviation.
pub(super) fn mean(rows: &[Row], form: DriverForm, level_nt: f64) -> CurvePoint {
    let n = rows.len() as f64;
    let of = |value: &dyn Fn(&Row) -> f64| rows.iter().map(value).sum::<f64>() / n;
    let mean = of(&|row| row.left_nt);
    let square = of(&|row| (row.left_nt - mean).powi(2));
    let alike = (n / ROWS_ALIKE).max(1.0);
    let (value, half) = match form {
        DriverForm::Variance => (square.sqrt(), TWO_SIGMA * square.sqrt() / (2.0 * alike).sqrt()),
        _ => (mean, TWO_SIGMA * (square / alike).sqrt()),
    };
    CurvePoint {
        driver: of(&|row| row.along),
        left_nt: value,
        band_nt: [value - half, value + half],
        fitted_nt: of(&|row| row.fitted_nt) - level_nt,
    }
}

/// Of parts of an axis.
pub(super) fn curve(drawn: &Drawn<'_>, over: &Expr, parts: usize) -> Option<Vec<CurvePoint>> {
    let mut rows = drawn.rows(over)?;
    if rows.len() < 10 * parts {
        return None;
    }
    rows.sort_by(|a, b| a.along.total_cmp(&b.along));
    let part = |part: usize| &rows[part * rows.len() / parts..(part + 1) * rows.len() / parts];
    Some((0..parts).map(|k| mean(part(k), drawn.form, drawn.level_nt)).collect())
}
