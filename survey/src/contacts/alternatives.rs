//! What else than a dipole may have made it: a single false reading, a step, or what compensation has left or taken.

use nalgebra::DMatrix;

use super::window::Window;
use crate::level::TOLD;

/// What explains a place as well as a dipole does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alternative {
    /// Readings of the mean that begins at this cell are false.
    Spike(usize),
    /// The level changes at this cell by so much, nT.
    Step(usize, f64),
    /// The 18 terms, which leave so many whitened squares.
    Terms(f64),
}

/// A dipole has three parameters more than a step or a spike; each explains one of pure chance, and this is twice that.
const MARGIN: f64 = 6.0;
/// A false reading is one of means over so many cells at most.
const SPIKE_CELLS: usize = 2;
/// Scales of the leftover that are tried, powers of this.
const SCALE_RATIO: f64 = 4.0;
const SCALES: i32 = 16;
/// Combinations of the terms below this share of the largest square are rounding.
const LEAST_TOLD: f64 = 1e-10;

/// The alternative that does as well as a dipole that explains `glrt`, if one does. `about` are the means from first to last where
/// it would be; `terms` is a row each of the combinations of the 18 terms that can be told, scaled to their changes over the
/// recording.
pub(super) fn better(window: &Window<'_>, glrt: f64, about: [usize; 2], terms: &[[f64; TOLD]]) -> Option<Alternative> {
    let count = window.starts.len();
    let (from, to) = (about[0].max(1), about[1].min(count));
    let places: Vec<usize> = (from..to).collect();
    let steps = DMatrix::from_fn(count, places.len(), |row, k| if row >= places[k] { 1.0 } else { 0.0 });
    let spikes = DMatrix::from_fn(count, places.len(), |row, k| if row == places[k] { 1.0 } else { 0.0 });
    let step = best(window, steps).map(|(k, size, own)| (Alternative::Step(window.starts[places[k]], size), own));
    let spike = best(window, spikes).filter(|_| window.cells <= SPIKE_CELLS);
    let spike = spike.map(|(k, _, own)| (Alternative::Spike(window.starts[places[k]]), own));
    let either = [step, spike].into_iter().flatten().max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((alternative, _)) = either.filter(|(_, own)| own + MARGIN >= glrt) {
        return Some(alternative);
    }
    // Evidence of three amplitudes of a scale that fits best, as of the terms.
    let of_dipole = glrt - 3.0 * (glrt / 3.0).max(1.0).ln();
    let along = along_terms(window, terms);
    (evidence(&along) >= of_dipole).then(|| Alternative::Terms(window.z.norm_squared() - explained(&along)))
}

/// Index of the column that explains most, its size, and twice the log likelihood ratio.
fn best(window: &Window<'_>, columns: DMatrix<f64>) -> Option<(usize, f64, f64)> {
    let white = window.whitened(columns);
    let of = |(k, column): (usize, nalgebra::DVectorView<'_, f64>)| {
        let (square, product) = (column.norm_squared(), column.dot(&window.z));
        (square > 0.0).then(|| (k, product / square, product * product / square))
    };
    white.column_iter().enumerate().filter_map(of).max_by(|a, b| a.2.total_cmp(&b.2))
}

/// What least squares of the terms explain.
fn explained(along: &[(f64, f64)]) -> f64 {
    let largest = along.iter().map(|(square, _)| *square).fold(0.0, f64::max);
    let told = along.iter().filter(|(square, _)| *square > LEAST_TOLD * largest);
    told.map(|(square, product)| product * product / square).sum()
}

/// Twice the logarithm of the evidence for a leftover of the terms over noise alone, at the scale of its coefficients that fits best.
fn evidence(along: &[(f64, f64)]) -> f64 {
    let largest = along.iter().map(|(square, _)| *square).fold(f64::MIN_POSITIVE, f64::max);
    let of_scale = |scale: f64| -> f64 {
        let of = |(square, product): &(f64, f64)| {
            product * product * scale / (1.0 + square * scale) - (1.0 + square * scale).ln()
        };
        along.iter().map(of).sum()
    };
    (0..SCALES).map(|k| of_scale(SCALE_RATIO.powi(k) / largest)).fold(0.0, f64::max)
}

/// Along each combination of the whitened terms that is orthogonal to the others: its square, and its product with the values.
fn along_terms(window: &Window<'_>, terms: &[[f64; TOLD]]) -> Vec<(f64, f64)> {
    if terms.is_empty() {
        return Vec::new();
    }
    let mean =
        |rows: &Vec<usize>, term: usize| rows.iter().map(|row| terms[*row][term]).sum::<f64>() / rows.len() as f64;
    let raw = DMatrix::from_fn(window.rows.len(), TOLD, |row, term| mean(&window.rows[row], term));
    let white = window.whitened(raw);
    let eigen = white.tr_mul(&white).symmetric_eigen();
    let products = eigen.eigenvectors.tr_mul(&white.tr_mul(&window.z));
    eigen.eigenvalues.iter().zip(products.iter()).map(|(square, product)| (square.max(0.0), *product)).collect()
}
