//! Rows that are left out about targets: what dipoles have wrong of them is more than noise there.

use super::trimmed::count;
use super::{Target, Targets};
use crate::diagnosis::policy::{
    TARGET_ERRORS_TRUSTED, TARGET_FURTHER_LEAST_LEFT, TARGET_LEAST_ERROR, TARGET_LEAST_LEFT, TARGET_STEPS_AT_FIRST,
};

impl Targets {
    /// Usable rows without those where a target is so large that no dipole describes it well enough. Where targets leave
    /// little else, more of each is trusted.
    pub(crate) fn without_cores(&self, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        // In steps toward the least of the errors that are trusted to be none.
        let left = |steps: usize| match steps.checked_sub(1) {
            Some(index) => self.without_errors(TARGET_ERRORS_TRUSTED[index], epochs_s, usable),
            None => usable.to_vec(),
        };
        let enough = |steps: usize, share: f64| {
            Some((steps, left(steps))).filter(|(_, left)| count(left) >= share * count(usable))
        };
        let at_first = (1..=TARGET_STEPS_AT_FIRST).rev().find_map(|steps| enough(steps, TARGET_LEAST_LEFT));
        let (at_first, rows) = at_first.unwrap_or_else(|| (0, left(0)));
        let furthest = (at_first + self.further).min(TARGET_ERRORS_TRUSTED.len());
        let further = (at_first + 1..=furthest).rev().find_map(|steps| enough(steps, TARGET_FURTHER_LEAST_LEFT));
        further.map_or(rows, |(_, rows)| rows)
    }

    /// The same with more rows about them left out; none where too few would be left, or no target is so large.
    pub(crate) fn with_further_left_out(&self, epochs_s: &[f64], usable: &[bool]) -> Option<Self> {
        let left = |targets: &Self| count(&targets.without_cores(epochs_s, usable));
        let before = left(self);
        let further = self.further + 1..=TARGET_ERRORS_TRUSTED.len();
        further.map(|further| Self { further, ..self.clone() }).find(|further| left(further) < before)
    }

    /// Usable rows without those where what its dipole has wrong of a target may be larger than so many standard deviations of the noise.
    fn without_errors(&self, sigmas: f64, epochs_s: &[f64], usable: &[bool]) -> Vec<bool> {
        let mut usable = usable.to_vec();
        for Target { dipole, noise_nt, error, .. } in &self.all {
            let reach_s = dipole.reach_s(sigmas * noise_nt / error.max(TARGET_LEAST_ERROR));
            let first = epochs_s.partition_point(|s| *s < dipole.epoch_s - reach_s);
            let end = epochs_s.partition_point(|s| *s <= dipole.epoch_s + reach_s);
            if reach_s > 0.0 {
                usable[first..end].fill(false);
            }
        }
        usable
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::targets::dipole::Dipole;

    /// One that has an error, and times of so many rows a second about it.
    fn passed(sigmas: f64, error: f64) -> (Targets, Vec<f64>) {
        let noise_nt = 0.05;
        let dipole = Dipole { epoch_s: 60.0, distance_s: 2.0, amplitudes_nt: [sigmas * noise_nt, 0.0, 0.0] };
        let target = Target { dipole, probability: 0.99, is_part: false, is_seen: true, glrt: 0.0, noise_nt, error };
        let epochs_s = (0..1200).map(|row| 0.1 * f64::from(row)).collect();
        (Targets { all: vec![target], further: 0 }, epochs_s)
    }

    /// How many of the rows of two minutes it leaves whose peak is so many standard deviations of the noise.
    fn left_beside(sigmas: f64, error: f64) -> f64 {
        let (targets, epochs_s) = passed(sigmas, error);
        count(&targets.without_cores(&epochs_s, &[true; 1200]))
    }

    #[test]
    fn a_target_is_fitted_but_for_the_core_of_a_large_one() {
        assert_eq!(left_beside(90.0, 0.0), 1200.0);
        // Its third profile, (1 + u^2)^(-5/2), is a tenth of its peak at u = 1.23, which is 2.5 s on either side.
        assert!((left_beside(1000.0, 0.0) - 1150.0).abs() < 6.0, "{}", left_beside(1000.0, 0.0));
        assert!(left_beside(10_000.0, 0.0) < left_beside(1000.0, 0.0));
        // And but for more of one that the dipole describes badly: there an error of a tenth is the noise at a hundredth of the peak.
        assert_eq!(left_beside(1000.0, 0.1), left_beside(10_000.0, 0.01));
    }

    #[test]
    fn further_rows_are_left_out_while_enough_are_left() {
        let (mut targets, epochs_s) = passed(1000.0, 0.02);
        let mut left = left_beside(1000.0, 0.02);
        let mut steps = 0;
        while let Some(further) = targets.with_further_left_out(&epochs_s, &[true; 1200]) {
            let now = count(&further.without_cores(&epochs_s, &[true; 1200]));
            assert!(now < left && now > 240.0, "{now} of {left}");
            (targets, left, steps) = (further, now, steps + 1);
        }
        assert_eq!(steps, 2);
        // Nothing is left out of what no target touches, or targets are all over.
        assert!(Targets::default().with_further_left_out(&epochs_s, &[true; 1200]).is_none());
        let (everywhere, epochs_s) = passed(1e12, 0.1);
        assert!(everywhere.with_further_left_out(&epochs_s, &[true; 1200]).is_none());
    }
}
