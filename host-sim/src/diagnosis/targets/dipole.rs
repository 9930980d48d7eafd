//! The anomaly of a dipole that is passed on a straight line at a constant speed.

use std::ops::Range;

pub(crate) use towmag_survey::contacts::profiles;

use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::policy::{TARGET_MET_DISTANCES, TARGET_MET_RATIO, TARGET_SIZE_RATIO};

/// Beyond so many distances a dipole does not count: the profiles have 1 / 200 of their peaks there.
pub(super) const REACH_DISTANCES: f64 = 6.0;
/// Step of the difference quotients by moment and distance, as a share of the distance.
const DERIVATIVE_STEP: f64 = 0.02;

/// A dipole that the body passed, as the total field shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dipole {
    /// When it was nearest, s since the recording's first row.
    pub(crate) epoch_s: f64,
    /// Its distance then over the speed, s.
    pub(crate) distance_s: f64,
    /// Amplitudes of the three [profiles], nT.
    pub(crate) amplitudes_nt: [f64; 3],
}

/// A block that a dipole reaches.
pub(super) struct Reached {
    /// Which of the whitening's.
    pub(super) index: usize,
    pub(super) rows: Range<usize>,
    pub(super) samples: Range<usize>,
}

impl Dipole {
    /// The blocks that it reaches; `epochs_s` are the times of all rows.
    pub(super) fn reached<'w>(
        &self,
        whitening: &'w Whitening,
        epochs_s: &'w [f64],
    ) -> impl Iterator<Item = Reached> + use<'w> {
        let (epoch_s, reach_s) = (self.epoch_s, REACH_DISTANCES * self.distance_s);
        let is_reached = move |rows: &Range<usize>| {
            epochs_s[rows.end - 1] >= epoch_s - reach_s && epochs_s[rows.start] <= epoch_s + reach_s
        };
        let blocks = whitening.blocks().iter().zip(whitening.ranges()).enumerate();
        blocks
            .map(|(index, (block, samples))| Reached { index, rows: block.rows.clone(), samples })
            .filter(move |reached| is_reached(&reached.rows))
    }

    /// Whether another one is as near and at the same moment, to a tenth of the distance.
    pub(super) fn is_about(&self, other: &Self) -> bool {
        let apart_s = [self.epoch_s - other.epoch_s, self.distance_s - other.distance_s];
        apart_s.iter().all(|apart_s| apart_s.abs() < 0.1 * self.distance_s)
    }

    /// Whether another one is at the same place as far as two can be told apart: not a distance apart, and about as near.
    pub(super) fn has_met(&self, other: &Self) -> bool {
        let (nearer_s, further_s) = (self.distance_s.min(other.distance_s), self.distance_s.max(other.distance_s));
        (self.epoch_s - other.epoch_s).abs() < TARGET_MET_DISTANCES * further_s
            && further_s < TARGET_MET_RATIO * nearer_s
    }

    /// Whether its largest value is about that of another one.
    pub(super) fn is_as_large_as(&self, other: &Self) -> bool {
        let ratio = (self.largest_lobe().peak_nt / other.largest_lobe().peak_nt).abs();
        (1.0 / TARGET_SIZE_RATIO..=TARGET_SIZE_RATIO).contains(&ratio)
    }

    /// Anomaly at a time, nT.
    pub(crate) fn anomaly_nt(&self, epoch_s: f64) -> f64 {
        let profiles = profiles((epoch_s - self.epoch_s) / self.distance_s);
        profiles.iter().zip(self.amplitudes_nt).map(|(profile, nt)| profile * nt).sum()
    }

    /// The three profiles, one value a time each.
    pub(crate) fn profiles(&self, epochs_s: &[f64]) -> [Vec<f64>; 3] {
        let rows: Vec<[f64; 3]> = epochs_s.iter().map(|s| profiles((s - self.epoch_s) / self.distance_s)).collect();
        [0, 1, 2].map(|k| rows.iter().map(|row| row[k]).collect())
    }

    /// What a fit of it is made of, one value a time: the profiles, then what a little later and a little further away
    /// changes.
    pub(crate) fn columns(&self, epochs_s: &[f64]) -> Vec<Vec<f64>> {
        let step_s = DERIVATIVE_STEP * self.distance_s;
        let later = Self { epoch_s: self.epoch_s + step_s, ..*self };
        let further = Self { distance_s: self.distance_s + step_s, ..*self };
        let at = |epoch_s: &f64| {
            let [a, b, c] = profiles((epoch_s - self.epoch_s) / self.distance_s);
            let change = |other: &Self| other.anomaly_nt(*epoch_s) - self.anomaly_nt(*epoch_s);
            [a, b, c, change(&later), change(&further)]
        };
        let rows: Vec<[f64; 5]> = epochs_s.iter().map(at).collect();
        (0..5).map(|k| rows.iter().map(|row| row[k]).collect()).collect()
    }

    /// How far from its moment it is larger than `nt`, s, as a whole number of steps of a tenth of its distance; 0 where it
    /// nowhere is.
    pub(crate) fn reach_s(&self, nt: f64) -> f64 {
        // Beyond, each profile falls at least as 1 / u^3.
        let most: f64 = self.amplitudes_nt.iter().map(|nt| nt.abs()).sum();
        let furthest = (10.0 * (most / nt.max(f64::MIN_POSITIVE)).cbrt().min(1000.0)).ceil() as usize;
        let is_larger = |step: &usize| {
            let off_s = 0.1 * *step as f64 * self.distance_s;
            self.anomaly_nt(self.epoch_s + off_s).abs().max(self.anomaly_nt(self.epoch_s - off_s).abs()) > nt
        };
        (0..=furthest).rev().find(is_larger).map_or(0.0, |step| 0.1 * (step + 1) as f64 * self.distance_s)
    }

    /// Its largest value, nT with its sign, when that is, s since the first row, and how wide that lobe is between its
    /// half heights, s.
    pub(crate) fn largest_lobe(&self) -> Lobe {
        const STEPS: i32 = 400;
        let epoch_s = |step: i32| self.epoch_s + f64::from(step) * 0.01 * self.distance_s;
        let nt = |step: i32| self.anomaly_nt(epoch_s(step));
        let top = (-STEPS..=STEPS).max_by(|a, b| nt(*a).abs().total_cmp(&nt(*b).abs())).unwrap_or(0);
        let peak_nt = nt(top);
        let edge = |by: i32| {
            let mut step = top;
            while (step - top).abs() < 2 * STEPS && nt(step) / peak_nt > 0.5 {
                step += by;
            }
            step
        };
        let width_s = f64::from(edge(1) - edge(-1)) * 0.01 * self.distance_s;
        Lobe { epoch_s: epoch_s(top), peak_nt, width_s }
    }
}

/// The largest lobe of an anomaly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lobe {
    /// When it is largest, s since the first row.
    pub(crate) epoch_s: f64,
    /// With its sign, nT.
    pub(crate) peak_nt: f64,
    /// Between the half heights, s.
    pub(crate) width_s: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Total-field anomaly of a dipole of a moment, A m^2, at `at`, m, along a field's direction: straight from the law.
    fn field_nt(moment: [f64; 3], at: [f64; 3], along: [f64; 3]) -> f64 {
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let r = dot(at, at).sqrt();
        let unit = at.map(|x| x / r);
        let vector = [0, 1, 2].map(|i| 3.0 * dot(moment, unit) * unit[i] - moment[i]);
        100.0 / r.powi(3) * dot(vector, along)
    }

    #[test]
    fn any_dipole_on_a_straight_line_is_a_sum_of_the_profiles() {
        let (moment, along, speed, distance) = ([30.0, -12.0, 55.0], [0.48, 0.36, 0.8], 2.0, [3.0, 4.0]);
        let truth = |t: f64| field_nt(moment, [-speed * t, distance[0], distance[1]], along);
        // Three values give the amplitudes; all others follow.
        let rows = nalgebra::Matrix3::from_fn(|i, k| profiles([-0.5, 0.1, 0.9][i])[k]);
        let at = |u: f64| truth(u * 5.0 / speed);
        let amplitudes = rows.lu().solve(&nalgebra::Vector3::new(at(-0.5), at(0.1), at(0.9))).unwrap();
        let dipole = Dipole { epoch_s: 0.0, distance_s: 5.0 / speed, amplitudes_nt: amplitudes.into() };
        for t in [-20.0, -3.0, 0.0, 1.7, 8.0] {
            assert!((dipole.anomaly_nt(t) - truth(t)).abs() < 1e-9 * truth(0.0).abs().max(1.0), "{t}");
        }
    }

    #[test]
    fn a_dipole_that_runs_away_is_no_longer_about_as_large() {
        let of = |nt: f64| Dipole { epoch_s: 100.0, distance_s: 2.0, amplitudes_nt: [0.3 * nt, -0.2 * nt, nt] };
        assert!([70.0, -180.0].iter().all(|nt| of(*nt).is_as_large_as(&of(129.0))));
        assert!([30.0, 1618.0, f64::INFINITY].iter().all(|nt| !of(*nt).is_as_large_as(&of(129.0))));
    }

    #[test]
    fn the_lobe_and_the_reach_are_those_of_the_curve() {
        let dipole = Dipole { epoch_s: 100.0, distance_s: 2.0, amplitudes_nt: [8.0, 0.0, 0.0] };
        let lobe = dipole.largest_lobe();
        assert_eq!((lobe.epoch_s, lobe.peak_nt), (100.0, 8.0));
        // (1 + u^2)^(5/2) = 2 at u = 0.5653.
        assert!((lobe.width_s - 2.0 * 0.5653 * 2.0).abs() < 0.06, "{}", lobe.width_s);
        let reach_s = dipole.reach_s(0.1);
        assert!(dipole.anomaly_nt(100.0 + reach_s) <= 0.1 && dipole.anomaly_nt(100.0 + reach_s - 0.4) > 0.1);
        assert_eq!(dipole.reach_s(9.0), 0.0);
    }
}
