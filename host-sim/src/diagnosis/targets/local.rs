//! A dipole fitted to the rows about it: the moment, the distance and the amplitudes that leave least.

use nalgebra::{DMatrix, DVector};

use super::dipole::Dipole;
use crate::diagnosis::policy::{RATE_HZ, TARGET_BACKGROUND_TERM_S, TARGET_DISTANCES_S};

/// First steps of the search for moment and distance, as shares of the distance, and how often they are halved.
const FIRST_STEPS: [f64; 2] = [0.25, 0.2];
const HALVINGS: usize = 6;
/// Steps of one size at most.
const MOST_STEPS: usize = 8;
/// Distances that are tried at first, over the one to start from.
const FIRST_RATIOS: [f64; 6] = [0.35, 0.5, 0.7, 1.4, 2.0, 2.8];
/// Rows that are fitted: so many distances on either side, but no fewer and no more than these, s.
const WINDOW_DISTANCES: f64 = 4.0;
const WINDOW_S: [f64; 2] = [5.0, 50.0];

/// What a fit of everything else leaves, one value a row.
pub(super) struct Left<'b> {
    pub(super) epochs_s: &'b [f64],
    pub(super) usable: &'b [bool],
    /// nT.
    pub(super) nt: Vec<f64>,
}

impl Left<'_> {
    /// Without a dipole, or with it again.
    pub(super) fn add(&mut self, dipole: &Dipole, sign: f64) {
        let added = self.epochs_s.iter().map(|s| sign * dipole.anomaly_nt(*s));
        self.nt.iter_mut().zip(added).for_each(|(nt, added)| *nt += added);
    }

    /// The dipole near another one that leaves least, beside a slow background; that one where too few rows are there.
    pub(super) fn fitted_from(&self, start: Dipole) -> Dipole {
        // Twice: the first one says how far it reaches.
        (0..2).fold(start, |dipole, _| self.fitted_once(dipole))
    }

    fn fitted_once(&self, start: Dipole) -> Dipole {
        let Some(window) = Window::about(self, &start) else { return start };
        let at = |ratio: f64| window.fitted(Dipole { distance_s: possible(start.distance_s * ratio), ..start });
        let mut best = FIRST_RATIOS.into_iter().map(at).fold(window.fitted(start), better);
        let mut steps = FIRST_STEPS;
        for _ in 0..=HALVINGS {
            for _ in 0..MOST_STEPS {
                let next =
                    neighbours(&best.0, steps).map(|dipole| window.fitted(dipole)).into_iter().fold(best, better);
                if next.1 >= best.1 {
                    break;
                }
                best = next;
            }
            steps = steps.map(|step| 0.5 * step);
        }
        best.0
    }
}

fn better(a: (Dipole, f64), b: (Dipole, f64)) -> (Dipole, f64) {
    if b.1 < a.1 { b } else { a }
}

fn possible(distance_s: f64) -> f64 {
    distance_s.clamp(TARGET_DISTANCES_S[0], TARGET_DISTANCES_S[1])
}

fn neighbours(dipole: &Dipole, [moment, distance]: [f64; 2]) -> [Dipole; 4] {
    let Dipole { epoch_s, distance_s, amplitudes_nt } = *dipole;
    [(moment, 0.0), (-moment, 0.0), (0.0, distance), (0.0, -distance)].map(|(later, further)| Dipole {
        epoch_s: epoch_s + later * distance_s,
        distance_s: possible(distance_s * (1.0 + further)),
        amplitudes_nt,
    })
}

/// The rows about a dipole.
struct Window {
    epochs_s: Vec<f64>,
    nt: DVector<f64>,
    /// Orthonormal, the slow background.
    background: DMatrix<f64>,
}

impl Window {
    fn about(left: &Left<'_>, dipole: &Dipole) -> Option<Self> {
        let half_s = (WINDOW_DISTANCES * dipole.distance_s).clamp(WINDOW_S[0], WINDOW_S[1]);
        let near = |row: &usize| left.usable[*row] && (left.epochs_s[*row] - dipole.epoch_s).abs() <= half_s;
        let rows: Vec<usize> = (0..left.nt.len()).filter(near).collect();
        let terms = (2.0 * half_s / TARGET_BACKGROUND_TERM_S).round() as usize + 2;
        if (rows.len() as f64) < half_s * RATE_HZ || rows.len() < terms + 10 {
            return None;
        }
        let epochs_s: Vec<f64> = rows.iter().map(|&row| left.epochs_s[row]).collect();
        let angle = |k: usize| ((epochs_s[k] - dipole.epoch_s) / half_s).clamp(-1.0, 1.0).acos();
        // Chebyshev polynomials.
        let background = DMatrix::from_fn(rows.len(), terms, |k, degree| (degree as f64 * angle(k)).cos()).qr().q();
        let nt = without(&background, DVector::from_iterator(rows.len(), rows.iter().map(|&row| left.nt[row])));
        Some(Self { epochs_s, nt, background })
    }

    /// With its amplitudes at their best, and the sum of the squares that it leaves.
    fn fitted(&self, dipole: Dipole) -> (Dipole, f64) {
        let columns = dipole.columns(&self.epochs_s);
        let columns = [0, 1, 2].map(|i| without(&self.background, DVector::from_column_slice(&columns[i])));
        let matrix = DMatrix::from_columns(&columns);
        let singular = matrix.clone().svd(true, true);
        let least = 1e-6 * singular.singular_values.max();
        let Ok(amplitudes) = singular.solve(&self.nt, least) else { return (dipole, f64::INFINITY) };
        let left = (&self.nt - matrix * &amplitudes).norm_squared();
        (Dipole { amplitudes_nt: [amplitudes[0], amplitudes[1], amplitudes[2]], ..dipole }, left)
    }
}

fn without(basis: &DMatrix<f64>, column: DVector<f64>) -> DVector<f64> {
    let along = basis.transpose() * &column;
    column - basis * along
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dipole_on_a_slow_background_is_found_from_near_by() {
        let epochs_s: Vec<f64> = (0..1200).map(|k| 0.1 * f64::from(k)).collect();
        let truth = Dipole { epoch_s: 61.3, distance_s: 2.2, amplitudes_nt: [9.0, -14.0, 3.0] };
        let nt =
            epochs_s.iter().map(|s| truth.anomaly_nt(*s) + 20.0 * (std::f64::consts::TAU * s / 90.0).sin()).collect();
        let left = Left { epochs_s: &epochs_s, usable: &[true; 1200], nt };
        let found = left.fitted_from(Dipole { epoch_s: 60.5, distance_s: 3.5, amplitudes_nt: [0.0; 3] });
        assert!(
            (found.epoch_s - truth.epoch_s).abs() < 0.05 && (found.distance_s - truth.distance_s).abs() < 0.1,
            "{found:?}"
        );
        assert!((found.largest_lobe().peak_nt / truth.largest_lobe().peak_nt - 1.0).abs() < 0.03);
    }
}
