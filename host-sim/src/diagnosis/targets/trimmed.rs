//! A fit to the rows that agree: those that stand out of it are left aside, until no others do.

use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{TARGET_OUTLIER_SIGMAS, TARGET_TRIMMED_MOST};

/// Rounds in which rows are left aside.
const ROUNDS: usize = 8;
/// Rows on either side of one that stands out that are left aside with it: a target is no single row.
const BESIDE_ROWS: usize = 10;

/// The last of some fits, each to the blocks of the rows that agree with the one before. `fitted` gives what it will, and
/// the residual at every row; `blocks` gives the blocks of some usable rows.
pub(super) fn trimmed<T>(
    usable: &[bool],
    blocks: impl Fn(&[bool]) -> Vec<Block>,
    fitted: impl Fn(&[Block]) -> (T, Vec<f64>),
) -> (T, Vec<f64>) {
    let plain = Whitening::new(&blocks(usable), Predictor::white(1.0), None);
    let rows: Vec<usize> = plain.rows().collect();
    let mut kept = usable.to_vec();
    let mut best = fitted(&blocks(&kept));
    for _ in 0..ROUNDS {
        let left = plain.apply(&best.1);
        let next = without_outliers(usable, &kept, &rows, &left);
        let agreeing = blocks(&next);
        if next == kept || agreeing.is_empty() || count(&next) < (1.0 - TARGET_TRIMMED_MOST) * count(usable) {
            break;
        }
        best = fitted(&agreeing);
        kept = next;
    }
    best
}

/// The usable rows without those that stand out of the spread of the kept ones, and their neighbours.
fn without_outliers(usable: &[bool], kept: &[bool], rows: &[usize], left: &[f64]) -> Vec<bool> {
    let inner: Vec<f64> = left.iter().zip(rows).filter(|(_, row)| kept[**row]).map(|(x, _)| *x).collect();
    let mut next = usable.to_vec();
    if inner.is_empty() {
        return next;
    }
    let most = TARGET_OUTLIER_SIGMAS * robust_mean_square(&inner).sqrt();
    for (_, &row) in left.iter().zip(rows).filter(|(x, _)| x.abs() > most) {
        let end = (row + BESIDE_ROWS + 1).min(next.len());
        next[row.saturating_sub(BESIDE_ROWS)..end].fill(false);
    }
    next
}

/// How many rows are usable.
pub(super) fn count(usable: &[bool]) -> f64 {
    usable.iter().filter(|&&usable| usable).count() as f64
}
