//! A fit to the rows that agree: those that stand out of it are left aside, until no others do.

use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{TARGET_OUTLIER_SIGMAS, TARGET_TRIMMED_MOST};

/// Rounds in which rows are left aside.
const ROUNDS: usize = 8;
/// Rows on either side of one that stands out that are left aside with it: a target is no single row.
const BESIDE_ROWS: usize = 10;

/// What a fit leaves, one value a row.
pub(super) struct Left {
    pub(super) left_nt: Vec<f64>,
    /// Of what was fitted.
    pub(super) coefficients: Vec<f64>,
    /// Variance of what is known to be louder at some rows than at others, nT^2.
    pub(super) known_nt2: Vec<f64>,
}

/// What the last of some fits leaves, each to the blocks of the rows that agree with the one before, and the blocks that it was fitted
/// to. `left_by` gives what a fit to some blocks leaves; `blocks` gives the blocks of some usable rows.
pub(super) fn trimmed(
    usable: &[bool],
    blocks: impl Fn(&[bool]) -> Vec<Block>,
    left_by: impl Fn(&[Block]) -> Left,
) -> (Vec<Block>, Left) {
    let mut fitted = blocks(usable);
    let plain = Whitening::new(&fitted, Predictor::white(1.0), None);
    let rows: Vec<usize> = plain.rows().collect();
    let mut kept = usable.to_vec();
    let mut left = left_by(&fitted);
    for _ in 0..ROUNDS {
        let next = without_outliers(usable, &kept, &rows, &plain, &left);
        let agreeing = blocks(&next);
        if next == kept || agreeing.is_empty() || count(&next) < (1.0 - TARGET_TRIMMED_MOST) * count(usable) {
            break;
        }
        left = left_by(&agreeing);
        (kept, fitted) = (next, agreeing);
    }
    (fitted, left)
}

/// The usable rows without those that stand out of the spread of the kept ones, and their neighbours.
fn without_outliers(usable: &[bool], kept: &[bool], rows: &[usize], plain: &Whitening, left: &Left) -> Vec<bool> {
    let Left { left_nt, known_nt2, .. } = left;
    let left = plain.apply(left_nt);
    let inner: Vec<f64> = left.iter().zip(rows).filter(|(_, row)| kept[**row]).map(|(x, _)| *x).collect();
    let mut next = usable.to_vec();
    if inner.is_empty() {
        return next;
    }
    let usual_nt2 = robust_mean_square(&inner);
    let most = |row: usize| TARGET_OUTLIER_SIGMAS * (usual_nt2 + known_nt2[row]).sqrt();
    for (_, &row) in left.iter().zip(rows).filter(|(x, row)| x.abs() > most(**row)) {
        let end = (row + BESIDE_ROWS + 1).min(next.len());
        next[row.saturating_sub(BESIDE_ROWS)..end].fill(false);
    }
    next
}

/// How many rows are usable.
pub(super) fn count(usable: &[bool]) -> f64 {
    usable.iter().filter(|&&usable| usable).count() as f64
}
