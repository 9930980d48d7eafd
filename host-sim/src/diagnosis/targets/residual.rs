//! What a fit leaves of a sensor, whitened to noise of variance 1, and fits of a dipole to it.

use std::ops::Range;

use super::dipole::{Dipole, Reached};
use super::rest::Rest;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{TARGET_DESCRIBED_ERRORS, TARGET_DISTANCES_S};
use crate::diagnosis::regression::problem::solve;
use crate::diagnosis::regression::projection::dot;

/// First steps of the search for moment and distance, as shares of the distance, and how often they are halved.
const FIRST_STEPS: [f64; 2] = [0.2, 0.15];
const HALVINGS: usize = 4;
/// Steps of one size at most.
const MOST_STEPS: usize = 6;
/// Distances that are tried at first, over the one to start from, and moments, in distances from it.
const FIRST_RATIOS: [f64; 6] = [0.35, 0.5, 0.7, 1.0, 1.4, 2.0];
const FIRST_MOMENTS: [f64; 5] = [-1.2, -0.6, 0.0, 0.6, 1.2];
/// The best of those that are followed.
const FOLLOWED: usize = 3;
/// How much larger than the range of what was read a dipole may be: noise and the slow background may hide a part.
const LARGEST_RATIO: f64 = 1.25;
/// Rows that count as those of a dipole, in distances.
const OWN_DISTANCES: f64 = 2.5;

/// The whitened residual of a fit.
pub(super) struct Residual<'a> {
    pub(super) whitening: &'a Whitening,
    /// Times of the rows since the first one, s.
    pub(super) epochs_s: &'a [f64],
    /// The residual before whitening, one a row, nT.
    residual_nt: &'a [f64],
    /// One a sample, the noise of variance 1.
    pub(super) z: Vec<f64>,
    /// The row of each sample, ascending.
    pub(super) row_of: Vec<usize>,
    /// What the whitened residual of the fit was divided by.
    pub(super) scale: f64,
}

/// A dipole, and what it does to the residual.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    pub(super) dipole: Dipole,
    /// What it explains, whitened.
    pub(super) glrt: f64,
    /// Sum of squares of what is left where it is, whitened, and of how many samples.
    left_sum: f64,
    samples: f64,
}

/// What a sensor says of an anomaly of the other one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Size of the anomaly here over that in the other sensor.
    pub(super) ratio: f64,
    /// How many standard deviations the anomaly is here, if it is there.
    pub(super) strength: f64,
}

impl Fitted {
    /// Mean square of what is left where it is, whitened.
    pub(super) fn left(&self) -> f64 {
        self.left_sum / self.samples.max(1.0)
    }

    /// Whether nothing is left where it is beside noise of a mean square, by the standard error of that of so many samples.
    pub(super) fn is_all(&self, noise: f64) -> bool {
        self.left() <= noise * (1.0 + TARGET_DESCRIBED_ERRORS * (2.0 / self.samples.max(1.0)).sqrt())
    }

    /// Share of the power where it is that it leaves, over noise of variance 1.
    pub(super) fn misfit(&self) -> f64 {
        (self.left_sum - self.samples).max(0.0) / (self.glrt + self.left_sum).max(f64::MIN_POSITIVE)
    }

    fn better(self, other: Self) -> Self {
        if other.glrt > self.glrt { other } else { self }
    }
}

/// The nearest distance that is looked for, s.
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

impl<'a> Residual<'a> {
    /// Of what is left of a sensor.
    pub(super) fn of(rest: &'a Rest, epochs_s: &'a [f64]) -> Self {
        Self::whitened(&rest.whitening, epochs_s, &rest.residual_nt, &rest.whitened)
    }

    /// Of a residual, one a row, nT, and what a whitening makes of it.
    pub(super) fn whitened(
        whitening: &'a Whitening,
        epochs_s: &'a [f64],
        residual_nt: &'a [f64],
        whitened: &[f64],
    ) -> Self {
        let scale = robust_mean_square(whitened).sqrt().max(f64::MIN_POSITIVE);
        let z = whitened.iter().map(|z| z / scale).collect();
        Self { whitening, epochs_s, residual_nt, z, row_of: whitening.rows().collect(), scale }
    }

    /// Whether a dipole is larger than all that the residual does where it is.
    fn is_too_large(&self, dipole: &Dipole) -> bool {
        let own_s = OWN_DISTANCES * dipole.distance_s;
        let first = self.epochs_s.partition_point(|s| *s < dipole.epoch_s - own_s);
        let end = self.epochs_s.partition_point(|s| *s <= dipole.epoch_s + own_s);
        let (low, high, most) = (first..end).filter(|row| self.residual_nt[*row].is_finite()).fold(
            (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64),
            |(low, high, most), row| {
                let nt = self.residual_nt[row];
                (low.min(nt), high.max(nt), most.max(dipole.anomaly_nt(self.epochs_s[row]).abs()))
            },
        );
        most > LARGEST_RATIO * (high - low)
    }

    /// One value a row, whose sum of products with any column is that of the whitened residual with the whitened column.
    pub(super) fn adjoint(&self) -> Vec<f64> {
        let mut adjoint = self.whitening.transposed(&self.z, self.epochs_s.len());
        // The columns, too, are to be in units of the noise.
        adjoint.iter_mut().for_each(|value| *value /= self.scale);
        adjoint
    }

    /// What this sensor says of a dipole that the other one shows.
    pub(super) fn seen(&self, dipole: &Dipole) -> Seen {
        let (mut along, mut own) = (0.0, 0.0);
        for Reached { index, rows, samples } in dipole.reached(self.whitening, self.epochs_s) {
            let anomaly = self.epochs_s[rows].iter().map(|s| dipole.anomaly_nt(*s) / self.scale);
            let anomaly = self.whitening.apply_block(index, &anomaly.collect::<Vec<f64>>());
            along += dot(&anomaly, &self.z[samples]);
            own += dot(&anomaly, &anomaly);
        }
        Seen { ratio: along / own.max(f64::MIN_POSITIVE), strength: own.sqrt() }
    }

    /// Samples of the rows within a distance of a row.
    pub(super) fn samples_near(&self, row: usize, rows: usize) -> Range<usize> {
        let first = self.row_of.partition_point(|other| *other + rows < row);
        first..self.row_of.partition_point(|other| *other <= row + rows)
    }

    /// The dipole near another one that explains most.
    pub(super) fn fitted_from(&self, start: &Dipole) -> Fitted {
        let at = |ratio: f64, moment: f64| {
            let distance_s = possible(start.distance_s * ratio);
            self.judged(&Dipole { epoch_s: start.epoch_s + moment * distance_s, distance_s, ..*start })
        };
        let moments = |ratio: f64| FIRST_MOMENTS.map(|moment| at(ratio, moment));
        let mut tried: Vec<Fitted> = FIRST_RATIOS.into_iter().flat_map(moments).collect();
        tried.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
        let followed = tried.into_iter().take(FOLLOWED).map(|first| self.followed(first));
        followed.reduce(Fitted::better).unwrap_or_else(|| self.judged(start))
    }

    /// The best that steps to all sides lead to.
    pub(super) fn followed(&self, first: Fitted) -> Fitted {
        let (mut best, mut steps) = (first, FIRST_STEPS);
        for _ in 0..=HALVINGS {
            for _ in 0..MOST_STEPS {
                let tried = neighbours(&best.dipole, steps).map(|dipole| self.judged(&dipole));
                let next = tried.into_iter().fold(best, Fitted::better);
                if next.glrt <= best.glrt {
                    break;
                }
                best = next;
            }
            steps = steps.map(|step| 0.5 * step);
        }
        best
    }

    /// What a dipole explains, its amplitudes at their best.
    pub(super) fn judged(&self, dipole: &Dipole) -> Fitted {
        let (epochs_s, whitening) = (self.epochs_s, self.whitening);
        let (mut columns, mut target, mut rows) = (vec![Vec::new(); 3], Vec::new(), Vec::new());
        for Reached { index, rows: own, samples } in dipole.reached(whitening, epochs_s) {
            let raw = dipole.profiles(&epochs_s[own.clone()]);
            for (column, raw) in columns.iter_mut().zip(&raw) {
                column.extend(whitening.apply_block(index, raw).into_iter().map(|x| x / self.scale));
            }
            target.extend_from_slice(&self.z[samples]);
            rows.extend(own);
        }
        if target.is_empty() {
            return Fitted { dipole: *dipole, glrt: 0.0, left_sum: 0.0, samples: 0.0 };
        }
        let (glrt, amplitudes, _) = solve(&columns, &target);
        let left = |k: usize| target[k] - (0..3).map(|i| columns[i][k] * amplitudes[i]).sum::<f64>();
        let own_s = OWN_DISTANCES * dipole.distance_s;
        let own: Vec<f64> = (0..target.len())
            .filter(|&k| (epochs_s[rows[k]] - dipole.epoch_s).abs() <= own_s)
            .map(|k| left(k).powi(2))
            .collect();
        let (left_sum, samples) = (own.iter().sum(), own.len() as f64);
        let amplitudes_nt = [amplitudes[0], amplitudes[1], amplitudes[2]];
        let dipole = Dipole { amplitudes_nt, ..*dipole };
        // With the background free, a wide dipole may be anything: it cannot be larger than what was read.
        let glrt = if self.is_too_large(&dipole) { 0.0 } else { glrt };
        Fitted { dipole, glrt, left_sum, samples }
    }
}
