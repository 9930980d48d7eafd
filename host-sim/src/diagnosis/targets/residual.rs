//! What a fit leaves of a sensor, whitened to noise of variance 1, and fits of a dipole to it.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::DVector;

use super::dipole::{Dipole, Reached};
use super::nuisance::{Beside, Local, Nuisance};
use super::rest::Rest;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::TARGET_DISTANCES_S;
use crate::diagnosis::regression::problem::solve;

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
pub(super) const OWN_DISTANCES: f64 = 2.5;
/// Rounds in which a dipole is fitted anew with what was fitted before free to change, and by what share it must explain more to go on.
const FREED_ROUNDS: usize = 8;
const FREED_LEAST_GAIN: f64 = 0.02;

/// The whitened residual of a fit.
pub(super) struct Residual<'a> {
    pub(super) whitening: &'a Whitening,
    /// Times of the rows since the first one, s.
    pub(super) epochs_s: &'a [f64],
    /// The residual before whitening, one a row, nT.
    residual_nt: Cow<'a, [f64]>,
    /// What was fitted, where that may have taken a part of a dipole, and its products with `z`.
    nuisance: Option<(&'a Nuisance, DVector<f64>)>,
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
        let residual = Self::whitened(&rest.whitening, epochs_s, &rest.residual_nt, &rest.whitened);
        let along = rest.nuisance.along(&residual.z);
        Self { nuisance: Some((&rest.nuisance, along)), ..residual }
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
        let row_of = whitening.rows().collect();
        Self { whitening, epochs_s, residual_nt: residual_nt.into(), nuisance: None, z, row_of, scale }
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
        let local = self.local(dipole, |epochs_s| [epochs_s.iter().map(|s| dipole.anomaly_nt(*s)).collect()]);
        let beside = self.nuisance.as_ref().and_then(|(nuisance, along)| nuisance.beside(&local, &self.z, along));
        let (along, own) = beside.map_or((0.0, 0.0), |beside| (beside.along[0], beside.gram[(0, 0)].max(0.0)));
        Seen { ratio: along / own.max(f64::MIN_POSITIVE), strength: own.sqrt() }
    }

    /// Columns where a dipole is, whitened, at its own samples and those that what was fitted was fitted to; `of` gives them for
    /// some times.
    fn local<const N: usize>(&self, dipole: &Dipole, of: impl Fn(&[f64]) -> [Vec<f64>; N]) -> Local {
        let mut local = Local { samples: Vec::new(), columns: vec![Vec::new(); N] };
        for Reached { index, rows, samples } in dipole.reached(self.whitening, self.epochs_s) {
            let whitened = of(&self.epochs_s[rows]).map(|raw| self.whitening.apply_block(index, &raw));
            for sample in samples.clone().filter(|&sample| self.counts(dipole, sample)) {
                local.samples.push(sample);
                for (column, values) in local.columns.iter_mut().zip(&whitened) {
                    column.push(values[sample - samples.start] / self.scale);
                }
            }
        }
        local
    }

    fn counts(&self, dipole: &Dipole, sample: usize) -> bool {
        let is_own = (self.epochs_s[self.row_of[sample]] - dipole.epoch_s).abs() <= OWN_DISTANCES * dipole.distance_s;
        is_own || self.nuisance.as_ref().is_none_or(|(nuisance, _)| nuisance.is_fitted(sample))
    }

    /// A dipole fitted anew with what was fitted before free to change, and the residual without what that took of it; none where
    /// that was little. It explains what no change of that could.
    pub(super) fn freed(&self, found: &Fitted) -> Option<(Self, Fitted)> {
        let mut best: Option<(Self, Fitted)> = None;
        for _ in 0..FREED_ROUNDS {
            let before = best.as_ref().map_or(found, |(_, fitted)| fitted);
            let residual = self.without_taken(&self.held_against(&before.dipole)?)?;
            let fitted = residual.followed(residual.judged(&before.dipole));
            if fitted.glrt <= (1.0 + FREED_LEAST_GAIN) * before.glrt {
                break;
            }
            best = Some((residual, fitted));
        }
        let (residual, fitted) = best?;
        let glrt = self.held_against(&fitted.dipole)?.explained().0;
        Some((residual, Fitted { glrt: glrt.min(fitted.glrt), ..fitted }))
    }

    /// The profiles of a dipole, all that was fitted before free to change.
    fn held_against(&self, dipole: &Dipole) -> Option<Beside> {
        let (nuisance, along) = self.nuisance.as_ref()?;
        nuisance.beside(&self.local(dipole, |epochs_s| dipole.profiles(epochs_s)), &self.z, along)
    }

    /// The residual without what was taken of a dipole by what was fitted before it was known; nothing is to be freed of it again.
    fn without_taken(&self, beside: &Beside) -> Option<Self> {
        let (nuisance, _) = self.nuisance.as_ref()?;
        let off = beside.off(&beside.explained().1);
        let (z, residual_nt) = nuisance.taken_off(&off, self.scale, &self.z, &self.residual_nt);
        let Self { whitening, epochs_s, scale, .. } = *self;
        let (residual_nt, row_of) = (residual_nt.into(), self.row_of.clone());
        Some(Self { whitening, epochs_s, residual_nt, nuisance: None, z, row_of, scale })
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

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::diagnosis::noise::blocks::Block;
    use crate::diagnosis::noise::whitening::Predictor;
    use crate::diagnosis::regression::products::dot;

    const NOISE_NT: f64 = 0.05;

    /// What a fit of `term` to all rows leaves of a reading, and what it was fitted to.
    fn left_of(reading_nt: &[f64], term: &[f64]) -> (Whitening, Vec<f64>) {
        let block = |rows: Range<usize>| Block { rows, missing: Vec::new(), targets: Vec::new() };
        let whitening = Whitening::new(&[block(0..600), block(600..1200)], Predictor::white(NOISE_NT), None);
        let [column, read] = [term, reading_nt].map(|values| whitening.apply(values));
        let size = dot(&column, &read) / dot(&column, &column);
        (whitening, reading_nt.iter().zip(term).map(|(nt, x)| nt - size * x).collect())
    }

    #[test]
    fn what_a_term_took_of_a_dipole_comes_back_with_it() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let epochs_s: Vec<f64> = (0..1200).map(|row| 0.1 * f64::from(row)).collect();
        let truth = Dipole { epoch_s: 40.0, distance_s: 3.0, amplitudes_nt: [-20.0, 60.0, 5.0] };
        // A heading that is steered while the dipole is passed, and motion for the rest of the time.
        let steered = |s: f64| if s < 60.0 { (-((s - 38.0) / 5.0).powi(2)).exp() } else { 0.3 * s.sin() };
        let term: Vec<f64> = epochs_s.iter().map(|s| steered(*s)).collect();
        let mut draw = || NOISE_NT * Distribution::<f64>::sample(&StandardNormal, &mut random);
        let at = |(s, x): (&f64, &f64)| truth.anomaly_nt(*s) + 8.0 * x + draw();
        let reading_nt: Vec<f64> = epochs_s.iter().zip(&term).map(at).collect();
        let (whitening, left_nt) = left_of(&reading_nt, &term);
        let whitened = whitening.apply(&left_nt);
        let nuisance = Nuisance::of(&[term], &whitening, &[true; 1200]);
        let residual = Residual::whitened(&whitening, &epochs_s, &left_nt, &whitened);
        let along = nuisance.along(&residual.z);
        let residual = Residual { nuisance: Some((&nuisance, along)), ..residual };
        let peak_nt = |fitted: &Fitted| fitted.dipole.largest_lobe().peak_nt;
        let alone = residual.fitted_from(&Dipole { epoch_s: 41.0, distance_s: 2.0, amplitudes_nt: [0.0; 3] });
        let (_, freed) = residual.freed(&alone).expect("the term took much of it");
        let peak_of_truth_nt = truth.largest_lobe().peak_nt;
        assert!((peak_nt(&alone) / peak_of_truth_nt - 1.0).abs() > 0.1, "{}", peak_nt(&alone));
        assert!((peak_nt(&freed) / peak_of_truth_nt - 1.0).abs() < 0.02, "{} {peak_of_truth_nt}", peak_nt(&freed));
        assert!(freed.left() < 1.5 * alone.left() && freed.left() < 1.3, "{} {}", freed.left(), alone.left());
    }
}
