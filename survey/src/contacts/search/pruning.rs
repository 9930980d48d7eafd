//! What is let go of again.

use super::{JOINT, LEAST_SHARE, Located, Search};
use crate::contacts::dipole::Dipole;
use crate::contacts::levelled::{RATE_HZ, WayBy};
use crate::level::MODEL_ERROR;

/// Nearer than this share of the larger distance, two dipoles are one that is no dipole.
const SAME: f64 = 0.7;
/// The background of a recording's ends is told from a contact this many distances inside.
const CONTACTS_FROM_ENDS: f64 = 3.0;
/// A candidate need not be: of strong iron by an end there is more than enough to take it off, and what is left of it would be in the
/// noise of minutes. With its peak and a flank inside.
pub(super) const CANDIDATES_FROM_ENDS: f64 = 1.0;

impl Search<'_> {
    /// Lets go of what the others explain too; it is not taken up again.
    pub(super) fn prune(&mut self) {
        let (kept, gone): (Vec<Located>, Vec<Located>) =
            self.found.iter().cloned().partition(|located| self.is_kept(located));
        if gone.is_empty() {
            return;
        }
        self.found = kept;
        for Located { stretch, fitted, .. } in gone {
            let row = self.way.row_at(fitted.dipole.at);
            if let Some(cell) = self.stretches[stretch].cell_near(row) {
                self.reject_alike(stretch, cell, fitted.dipole.distance / self.way.per_s[row]);
            }
        }
        self.refit();
    }

    fn is_kept(&self, located: &Located) -> bool {
        let (dipole, glrt) = (&located.fitted.dipole, located.fitted.glrt);
        // In a turn without a track, or with one that wanders, the way to strong iron is not what it is taken to be.
        let is_known = self.way.is_metres && self.options.way_by == WayBy::Positions;
        let least_error = if is_known { 0.0 } else { MODEL_ERROR };
        let beside = self.glrt_of_model_errors(dipole.at, |other| JOINT * other.distance, least_error);
        glrt > LEAST_SHARE * self.threshold() && glrt >= beside && self.is_inside(located, CANDIDATES_FROM_ENDS)
    }

    /// What contacts within a reach of a place of the way may leave there, being no dipoles as they are fitted: the most of one.
    pub(super) fn glrt_of_model_errors(&self, at: f64, reach: impl Fn(&Dipole) -> f64, least_error: f64) -> f64 {
        let is_near = |located: &&Located| (located.fitted.dipole.at - at).abs() < reach(&located.fitted.dipole);
        let of = |located: &Located| located.model_error.max(least_error).powi(2) * located.fitted.glrt;
        self.found.iter().filter(is_near).map(of).fold(0.0, f64::max)
    }

    /// Whether a candidate is far enough inside its stretch to be a contact.
    pub(in crate::contacts) fn may_be_contact(&self, index: usize) -> bool {
        self.is_inside(&self.found[index], CONTACTS_FROM_ENDS)
    }

    /// Whether the ends of its stretch are so many distances away.
    fn is_inside(&self, located: &Located, distances: f64) -> bool {
        let dipole = &located.fitted.dipole;
        let row = self.way.row_at(dipole.at);
        let Some(cell) = self.stretches[located.stretch].cell_near(row) else { return false };
        self.is_far_from_ends(located.stretch, cell, distances * dipole.distance / self.way.per_s[row])
    }

    /// Whether the ends of a stretch are at least so long from a cell.
    pub(super) fn is_far_from_ends(&self, stretch: usize, cell: usize, margin_s: f64) -> bool {
        let (margin, cell) = (margin_s * RATE_HZ, cell as f64);
        cell >= margin && cell + margin <= self.stretches[stretch].rows.len() as f64
    }

    /// Of fits that have met drops the one that explains least: together their amplitudes are anything, up to millions of nT, and so
    /// is the noise that is measured beside them.
    pub(super) fn drops_one_that_met(&mut self) -> bool {
        let glrt = |k: usize| self.found[k].fitted.glrt;
        let is_less = |k: usize, other: usize| (glrt(k), other) < (glrt(other), k);
        let dipole = |k: usize| &self.found[k].fitted.dipole;
        let all = 0..self.found.len();
        let met =
            all.clone().filter(|&k| all.clone().any(|other| is_less(k, other) && is_same(dipole(k), dipole(other))));
        let least = met.min_by(|a, b| glrt(*a).total_cmp(&glrt(*b)));
        least.map(|least| self.found.remove(least)).is_some()
    }
}

/// Whether two dipoles are too near each other to be told apart.
pub(super) fn is_same(a: &Dipole, b: &Dipole) -> bool {
    (a.at - b.at).abs() < SAME * a.distance.max(b.distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::levelled::{Levelled, Options};
    use crate::contacts::search::Search;

    /// Two fits that have come to lie on one target.
    #[test]
    fn of_fits_that_have_met_one_is_left_and_its_anomaly_is_that_of_the_target() {
        let time_s: Vec<f64> = (0..3_000).map(|row| 0.1 * row as f64).collect();
        let target_nt = |s: f64| 20.0 * (1.0 + ((s - 150.0) / 3.0).powi(2)).powf(-2.5);
        let noise_nt = |row: usize| 0.1 * ((row * 7_919 % 1_009) as f64 / 1_009.0 - 0.5);
        let field_nt: Vec<f64> =
            time_s.iter().enumerate().map(|(row, s)| 5e4 + target_nt(*s) + noise_nt(row)).collect();
        let levelled = Levelled {
            time_s: &time_s,
            is_valid: &[true; 3_000],
            field_nt: &field_nt,
            variance_nt2: None,
            terms: &[[0.0; 18]; 3_000],
            direction: &[[0.6, 0.0, 0.8]; 3_000],
            track: None,
            altitude_m: None,
            depth_m: None,
        };
        let mut search = Search::new(&levelled, Options::default());
        let fit = |at: f64| Dipole { at, distance: 3.0, side_rad: 0.0, amplitudes_nt: [10.0, 0.0, 0.0] };
        search.begin_with(&[fit(149.5), fit(150.5)]);
        search.prune();
        assert_eq!(search.found.len(), 1);
        let most = search.anomaly_nt().into_iter().fold(0.0, f64::max);
        assert!((most - 20.0).abs() < 0.5, "{most}");
    }
}
