//! The field as the fluxgate has it: the magnitude of its vector.

use super::rest::{Columns, Rest, rows_of};
use super::trimmed::{Left, trimmed};
use crate::diagnosis::base::filled;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::predictor_of_all;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::projection::Projection;
use crate::simulator::signals::Signals;

/// What the slow background and the fluxgate's own errors leave of the magnitude of its vector. `blocks` gives the blocks of some
/// usable rows; the errors are fitted to the rows that do not stand out.
pub(super) fn magnitude(
    table: &Prepared,
    signals: &Signals,
    usable: &[bool],
    blocks: impl Fn(&[bool]) -> Vec<Block>,
) -> Rest {
    let magnitude = filled(&table.magnitudes_nt());
    let errors = of_errors(&signals.rows().direction);
    let left_by = |blocks: &[Block]| {
        let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
        let whitened: Vec<Vec<f64>> = errors.iter().map(|column| whitening.apply(column)).collect();
        let sizes = Projection::of(&whitened).solve(&whitening.apply(&magnitude));
        let mut left = magnitude.clone();
        for (column, size) in errors.iter().zip(&sizes) {
            left.iter_mut().zip(column).for_each(|(left, x)| *left -= size * x);
        }
        Left { known_nt2: vec![0.0; left.len()], left_nt: left, coefficients: sizes }
    };
    let (fitted, Left { left_nt, .. }) = trimmed(usable, &blocks, left_by);
    // What its errors leave follows the motion, too: an anomaly stands out of that.
    let predictor = predictor_of_all(&left_nt, &fitted).unwrap_or_else(|| Predictor::white(1.0));
    let is_fitted = rows_of(&fitted, usable.len());
    let columns = Columns { columns_nt: &errors, is_fitted: &is_fitted };
    Rest::beside(Whitening::new(&blocks(usable), predictor, None), left_nt, f64::INFINITY, &columns)
}

/// What bias, scales, skewed axes and a cubic error of each make of the magnitude: polynomials of the direction.
fn of_errors(directions: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let column = |of: &dyn Fn(&[f64; 3]) -> f64| directions.iter().map(of).collect::<Vec<f64>>();
    let mut columns: Vec<Vec<f64>> = (0..3).map(|i| column(&|c| c[i])).collect();
    columns.extend((0..3).flat_map(|i| (i..3).map(move |j| (i, j))).map(|(i, j)| column(&|c| c[i] * c[j])));
    columns.push(column(&|c| c.iter().map(|c| c.powi(4)).sum()));
    columns
}
