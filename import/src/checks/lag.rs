//! Scalar and fluxgate out of step: the 18 terms fit best when the scalar is moved.

use nalgebra::{DMatrix, DVector};
use towmag::filter::{BandPassDesign, BandPassState};
use towmag::model::{TERMS, Terms, TermsState};
use towmag_recording::Column;

use super::usable;
use crate::draft::Draft;
use crate::finding::Finding;
use crate::source::FindingKind;

/// The farthest that is looked for, rows.
const FARTHEST: usize = 25;
/// A lag below half a row is not told: sensors and recorders have such.
const SMALLEST_S: f64 = 0.05;
/// What moving must do to the variance that the terms leave, before it is told.
const BETTER: f64 = 0.7;
/// Rows that the filter needs to settle.
const SETTLING: usize = 300;

/// Whether the scalar comes late or early.
pub(super) fn check(draft: &Draft) -> Option<Finding> {
    let lag_s = lag_s(draft)?;
    let word = if lag_s > 0.0 { "late" } else { "early" };
    let text = format!("the scalar comes {:.2} s {word} against the fluxgate", lag_s.abs());
    Some(Finding::warning(FindingKind::Lag, text).with(format!("--scalar-lag {lag_s:.2}")))
}

fn lag_s(draft: &Draft) -> Option<f64> {
    let (columns, signal) = filtered(draft)?;
    let rows = FARTHEST..signal.len() - FARTHEST;
    let regressors = DMatrix::from_fn(rows.len(), TERMS, |row, term| columns[rows.start + row][term]);
    let scale: Vec<f64> = regressors.column_iter().map(|column| column.norm().max(1e-12)).collect();
    let scaled = DMatrix::from_fn(rows.len(), TERMS, |row, term| regressors[(row, term)] / scale[term]);
    let normal = scaled.tr_mul(&scaled) + DMatrix::identity(TERMS, TERMS) * 1e-6;
    let factor = normal.cholesky()?;
    let left = |shift: usize| {
        let moved = DVector::from_fn(rows.len(), |row, _| signal[row + shift]);
        let right = scaled.tr_mul(&moved);
        moved.norm_squared() - right.dot(&factor.solve(&right))
    };
    let variances: Vec<f64> = (0..=2 * FARTHEST).map(left).collect();
    let best = (0..variances.len()).min_by(|&a, &b| variances[a].total_cmp(&variances[b]))?;
    if best == 0 || best == 2 * FARTHEST || variances[best] > BETTER * variances[FARTHEST] {
        return None;
    }
    let (before, at, after) = (variances[best - 1], variances[best], variances[best + 1]);
    let between = 0.5 * (before - after) / (before - 2.0 * at + after).max(f64::MIN_POSITIVE);
    let lag_s = (best as f64 - FARTHEST as f64 + between.clamp(-0.5, 0.5)) * 0.1;
    (lag_s.abs() >= SMALLEST_S).then_some(lag_s)
}

type Columns = Vec<[f64; TERMS]>;

/// The 18 columns and the scalar, in the band, of the longest stretch of rows that follow each other.
fn filtered(draft: &Draft) -> Option<(Columns, Vec<f64>)> {
    let (scalar, flux) = (draft.numbers(Column::Scalar)?, draft.flux()?);
    let rows = usable(draft, scalar, &flux);
    let follow = |a: &usize, b: &usize| b - a == 1 && draft.time_s[*b] - draft.time_s[*a] < 0.15;
    let stretch = rows.chunk_by(follow).max_by_key(|stretch| stretch.len())?;
    if stretch.len() < SETTLING + 300 {
        return None;
    }
    let band = BandPassDesign::default().build().ok()?;
    let (terms, mut memory) = (Terms::new(towmag::RATE_HZ as f32), TermsState::default());
    let mut state: Option<BandPassState<{ TERMS + 1 }>> = None;
    let (mut columns, mut signal) = (Vec::new(), Vec::new());
    let reference = scalar[stretch[0]];
    for &row in stretch {
        let axes = flux.map(|axis| axis[row] as f32);
        let size = flux.iter().map(|axis| axis[row] * axis[row]).sum::<f64>().sqrt();
        let Some(step) = terms.step(&mut memory, axes, size) else { continue };
        let mut input = [0.0; TERMS + 1];
        input[..TERMS].copy_from_slice(step.as_slice());
        input[TERMS] = (scalar[row] - reference) as f32;
        let output = band.step(state.get_or_insert_with(|| BandPassState::steady(&input)), &input);
        let mut column = [0.0; TERMS];
        column.iter_mut().zip(&output).for_each(|(column, output)| *column = f64::from(*output));
        columns.push(column);
        signal.push(f64::from(output[TERMS]));
    }
    Some((columns.split_off(SETTLING), signal.split_off(SETTLING)))
}
