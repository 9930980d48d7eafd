//! What is let go of again.

use super::{JOINT, LEAST_SHARE, Located, Search};
use crate::contacts::dipole::Dipole;
use crate::contacts::levelled::{RATE_HZ, WayBy};
use crate::contacts::way::Spot;
use crate::level::MODEL_ERROR;

/// Nearer than this share of the larger distance, two dipoles are one that is no dipole.
const SAME: f64 = 0.7;
/// A fit whose anomaly is larger than the field itself, so many times from peak to trough, is held by others that cancel it, and each
/// step of one makes the others larger, without end. Two equal and opposite dipoles as near each other as two may be leave more than one
/// of them has (1.2 times); iron never needs more.
const MOST_OF_SEEN: f64 = 3.0;
/// Looked at within so many distances of it: all but a hundredth of a dipole.
const SEEN_DISTANCES: f64 = 2.5;
/// At so many places to either side: a twentieth of a distance apart.
const PLACES: i32 = 50;
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
        for located in gone {
            if let Some((cell, distance_s)) = self.cell_and_distance_s(&located) {
                self.reject_alike(located.stretch, cell, distance_s);
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

    /// Whether a candidate is far enough inside its stretch to be a contact, and read where it is.
    pub(in crate::contacts) fn may_be_contact(&self, index: usize) -> bool {
        let located = &self.found[index];
        self.is_inside(located, CONTACTS_FROM_ENDS) && self.is_read(located)
    }

    /// Whether what was read has a good part of a candidate: a peak in a hole may be of any size.
    fn is_read(&self, located: &Located) -> bool {
        let dipole = &located.fitted.dipole;
        let step = SEEN_DISTANCES * dipole.distance / PLACES as f64;
        let places = (-PLACES..=PLACES).map(|k| self.way.spot(dipole.at + k as f64 * step));
        self.size_nt(dipole, &places.collect::<Vec<_>>()) <= MOST_OF_SEEN * self.seen_nt(&self.seen(dipole))
    }

    /// The cell of its stretch in which a candidate is, and its distance over speed there, s.
    fn cell_and_distance_s(&self, located: &Located) -> Option<(usize, f64)> {
        let dipole = &located.fitted.dipole;
        let row = self.way.row_at(dipole.at);
        let cell = self.stretches[located.stretch].cell_near(row)?;
        Some((cell, dipole.distance / self.way.per_s[row]))
    }

    /// Whether the ends of its stretch are so many distances away.
    fn is_inside(&self, located: &Located, distances: f64) -> bool {
        let Some((cell, distance_s)) = self.cell_and_distance_s(located) else { return false };
        self.is_far_from_ends(located.stretch, cell, distances * distance_s)
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

    /// Of fits that others cancel drops the one that exceeds most what is seen where it is.
    pub(super) fn drops_one_that_is_cancelled(&mut self) -> bool {
        let share = |index: usize| (index, self.share_of_seen(&self.found[index].fitted.dipole));
        let cancelled = (0..self.found.len()).map(share).filter(|(_, share)| *share > MOST_OF_SEEN);
        let most = cancelled.max_by(|a, b| a.1.total_cmp(&b.1));
        most.map(|(index, _)| self.found.remove(index)).is_some()
    }

    /// Whether a dipole exceeds what is seen where it is by more than iron does.
    pub(super) fn is_cancelled(&self, dipole: &Dipole) -> bool {
        self.share_of_seen(dipole) > MOST_OF_SEEN
    }

    /// A dipole's anomaly over the field in the rows that there are about it, both from peak to trough.
    fn share_of_seen(&self, dipole: &Dipole) -> f64 {
        let rows = self.seen(dipole);
        let spots: Vec<Spot> = rows.iter().map(|row| self.way.spot_of_row(*row)).collect();
        self.size_nt(dipole, &spots) / self.seen_nt(&rows).max(f64::MIN_POSITIVE)
    }

    /// The rows about a dipole that have a reading.
    fn seen(&self, dipole: &Dipole) -> Vec<usize> {
        let has_reading = |row: &usize| self.levelled().is_valid[*row] && self.field_nt[*row].is_finite();
        self.way.rows_about(dipole, SEEN_DISTANCES).filter(has_reading).collect()
    }

    /// The field in some rows from peak to trough, nT.
    fn seen_nt(&self, rows: &[usize]) -> f64 {
        peak_to_trough(rows.iter().map(|row| self.field_nt[*row] - self.body_nt[*row]))
    }

    /// A dipole's anomaly at some places from peak to trough, nT.
    fn size_nt(&self, dipole: &Dipole, spots: &[Spot]) -> f64 {
        peak_to_trough(dipole.linear_nt(&self.way, spots).into_iter())
    }
}

fn peak_to_trough(values: impl Iterator<Item = f64>) -> f64 {
    let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    (most - least).max(0.0)
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

    const ROWS: usize = 3_000;

    fn time_s() -> Vec<f64> {
        (0..ROWS).map(|row| 0.1 * row as f64).collect()
    }

    /// Noise and a target of 20 nT at 150 s.
    fn field_nt() -> Vec<f64> {
        let target_nt = |s: f64| 20.0 * (1.0 + ((s - 150.0) / 3.0).powi(2)).powf(-2.5);
        let noise_nt = |row: usize| 0.1 * ((row * 7_919 % 1_009) as f64 / 1_009.0 - 0.5);
        time_s().iter().enumerate().map(|(row, s)| 5e4 + target_nt(*s) + noise_nt(row)).collect()
    }

    fn levelled<'a>(time_s: &'a [f64], field_nt: &'a [f64], is_valid: &'a [bool]) -> Levelled<'a> {
        Levelled {
            time_s,
            is_valid,
            field_nt,
            variance_nt2: None,
            terms: &[[0.0; 18]; ROWS],
            direction: &[[0.6, 0.0, 0.8]; ROWS],
            track: None,
            altitude_m: None,
            depth_m: None,
        }
    }

    fn fit(at: f64, peak_nt: f64) -> Dipole {
        Dipole { at, distance: 3.0, side_rad: 0.0, amplitudes_nt: [peak_nt, 0.0, 0.0] }
    }

    #[test]
    fn of_fits_that_have_met_one_is_left_and_its_anomaly_is_that_of_the_target() {
        let (time_s, field_nt) = (time_s(), field_nt());
        let levelled = levelled(&time_s, &field_nt, &[true; ROWS]);
        let mut search = Search::new(&levelled, Options::default());
        search.begin_with(&[fit(149.5, 10.0), fit(150.5, 10.0)]);
        search.prune();
        assert_eq!(search.found.len(), 1);
        let most = search.anomaly_nt().into_iter().fold(0.0, f64::max);
        assert!((most - 20.0).abs() < 0.5, "{most}");
    }

    /// Nothing else tells of them: together they may describe the field as well as one does.
    #[test]
    fn fits_that_cancel_each_other_are_let_go_one_by_one_and_what_is_seen_stays() {
        let (time_s, field_nt) = (time_s(), field_nt());
        let levelled = levelled(&time_s, &field_nt, &[true; ROWS]);
        let mut search = Search::new(&levelled, Options::default());
        search.begin_with(&[fit(150.0, 20.0)]);
        let located = search.found[0].clone();
        let with = |dipole: Dipole| {
            let mut other = located.clone();
            other.fitted.dipole = dipole;
            other
        };
        search.found.extend([with(fit(147.0, 900.0)), with(fit(153.0, -880.0))]);
        assert!(search.drops_one_that_is_cancelled() && search.drops_one_that_is_cancelled());
        assert!(!search.drops_one_that_is_cancelled());
        assert!((search.found[0].fitted.dipole.at - 150.0).abs() < 0.1 && search.found.len() == 1);
    }

    #[test]
    fn a_peak_in_a_hole_is_a_contact_where_its_flanks_are_read() {
        let (time_s, field_nt) = (time_s(), field_nt());
        let is_contact = |hole: std::ops::Range<usize>| {
            let is_valid: Vec<bool> = (0..ROWS).map(|row| !hole.contains(&row)).collect();
            let levelled = levelled(&time_s, &field_nt, &is_valid);
            let mut search = Search::new(&levelled, Options::default());
            search.begin_with(&[fit(150.0, 20.0)]);
            search.found[0].fitted.dipole = fit(150.0, 20.0);
            search.may_be_contact(0)
        };
        assert!(is_contact(0..0) && is_contact(1_495..1_505) && is_contact(1_500..1_540));
        assert!(!is_contact(1_476..1_525));
    }
}
