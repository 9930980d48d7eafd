//! Scalar and fluxgate out of step: the 18 terms fit best when the scalar is moved.

use nalgebra::{SMatrix, SVector};
use towmag::filter::{BandPassDesign, BandPassState};
use towmag::model::TERMS;
use towmag_recording::Column;

use super::statistics::usable;
use crate::draft::Draft;
use crate::finding::Finding;
use crate::source::FindingKind;

/// The farthest that is looked for, rows.
const FARTHEST: usize = 25;
/// A lag below half a row is not told: sensors and recorders have such.
const SMALLEST_S: f64 = 0.05;
/// What moving must do to the variance that the terms leave, before it is told: in the eight flights, which have lags of their
/// own of up to 0.08 s, it leaves 0.99 and more.
const BETTER: f64 = 0.9;
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
    let variances = left(&columns, &signal)?;
    let best = (0..variances.len()).min_by(|&a, &b| variances[a].total_cmp(&variances[b]))?;
    if best == 0 || best == 2 * FARTHEST || variances[best] > BETTER * variances[FARTHEST] {
        return None;
    }
    let (before, at, after) = (variances[best - 1], variances[best], variances[best + 1]);
    let between = 0.5 * (before - after) / (before - 2.0 * at + after).max(f64::MIN_POSITIVE);
    let lag_s = (best as f64 - FARTHEST as f64 + between.clamp(-0.5, 0.5)) * 0.1;
    (lag_s.abs() >= SMALLEST_S).then_some(lag_s)
}

/// What the terms leave of the scalar's power for each shift. In one pass: a day of rows as matrices would be many times
/// the size of its recording.
fn left(columns: &[[f32; TERMS]], signal: &[f64]) -> Option<Vec<f64>> {
    let power = |term: usize| columns.iter().map(|row| f64::from(row[term]).powi(2)).sum::<f64>();
    let scale = Vector::from_fn(|term, _| power(term).sqrt().max(1e-12));
    let mut normal = Matrix::identity() * 1e-6;
    let mut shifts = vec![(Vector::zeros(), 0.0); 2 * FARTHEST + 1];
    for row in FARTHEST..signal.len() - FARTHEST {
        let regressors = Vector::from_fn(|term, _| f64::from(columns[row][term]) / scale[term]);
        normal.ger(1.0, &regressors, &regressors, 1.0);
        for ((right, squares), moved) in shifts.iter_mut().zip(&signal[row - FARTHEST..]) {
            right.axpy(*moved, &regressors, 1.0);
            *squares += moved * moved;
        }
    }
    let factor = normal.cholesky()?;
    Some(shifts.iter().map(|(right, squares)| squares - right.dot(&factor.solve(right))).collect())
}

type Matrix = SMatrix<f64, TERMS, TERMS>;
type Vector = SVector<f64, TERMS>;
type Columns = Vec<[f32; TERMS]>;

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
    let mut state: Option<BandPassState<{ TERMS + 1 }>> = None;
    let (mut columns, mut signal) = (Vec::new(), Vec::new());
    let reference = scalar[stretch[0]];
    for rows in stretch.windows(3) {
        let step = terms(&flux, rows);
        let row = rows[1];
        let mut input = [0.0; TERMS + 1];
        input[..TERMS].copy_from_slice(&step);
        input[TERMS] = (scalar[row] - reference) as f32;
        let output = band.step(state.get_or_insert_with(|| BandPassState::steady(&input)), &input);
        let mut column = [0.0; TERMS];
        column.copy_from_slice(&output[..TERMS]);
        columns.push(column);
        signal.push(f64::from(output[TERMS]));
    }
    Some((columns.split_off(SETTLING), signal.split_off(SETTLING)))
}

/// The 18 terms of the middle one of three rows. Their derivative is the centred one: the core's, which looks back, would
/// read as half a row of lag.
fn terms(flux: &[&[f64]; 3], rows: &[usize]) -> [f32; TERMS] {
    let size = |row: usize| flux.iter().map(|axis| axis[row] * axis[row]).sum::<f64>().sqrt();
    let cosines = |row: usize| flux.map(|axis| axis[row] / size(row));
    let (before, u, after) = (cosines(rows[0]), cosines(rows[1]), cosines(rows[2]));
    let change: [f64; 3] = std::array::from_fn(|axis| (after[axis] - before[axis]) / (2.0 * towmag::EPOCH_S));
    let scale = size(rows[1]) / f64::from(towmag::model::UNIT_FIELD_NT);
    let induced = (0..3).flat_map(|i| (i..3).map(move |j| (i, j))).map(|(i, j)| scale * u[i] * u[j]);
    let eddy = (0..9).map(|at| scale * u[at / 3] * change[at % 3]);
    let mut all = u.into_iter().chain(induced).chain(eddy);
    std::array::from_fn(|_| all.next().unwrap_or_default() as f32)
}
