//! What dipoles have wrong of their targets: the body heaves, turns and changes its speed as it passes, and no hull is a dipole.

use super::Targets;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::median;
use crate::diagnosis::policy::TARGET_ERROR_SIGMAS;

/// Sums over the rows in which a target is the largest, and stands out of the noise by far.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    rows: f64,
    left_nt2: f64,
    anomaly_nt2: f64,
}

impl Sums {
    /// Share of the target that its dipole leaves, by its rms; none where it stands out nowhere.
    fn error(&self, noise_nt: f64) -> Option<f64> {
        let left_nt2 = (self.left_nt2 - self.rows * noise_nt * noise_nt).max(0.0);
        (self.anomaly_nt2 > 0.0).then(|| (left_nt2 / self.anomaly_nt2).sqrt())
    }
}

impl Targets {
    /// With the share of each that its dipole leaves of `reading_nt`, one value a row, in which the targets are: never less than the middle
    /// of all, as a fit to few rows may hide its error. `blocks` are those of all rows with a reading.
    pub(super) fn with_errors(mut self, reading_nt: &[f64], noise_nt: f64, epochs_s: &[f64], blocks: &[Block]) -> Self {
        let sums = self.sums(reading_nt, noise_nt, epochs_s, blocks);
        let errors: Vec<Option<f64>> = sums.iter().map(|sums| sums.error(noise_nt)).collect();
        let known: Vec<f64> = errors.iter().copied().flatten().collect();
        let usual = if known.is_empty() { 0.0 } else { median(known) };
        for (target, error) in self.all.iter_mut().zip(errors) {
            target.error = error.unwrap_or(usual).max(usual);
        }
        self
    }

    /// Of each target, beside the slow background.
    fn sums(&self, reading_nt: &[f64], noise_nt: f64, epochs_s: &[f64], blocks: &[Block]) -> Vec<Sums> {
        let anomaly_nt = self.anomaly_nt(epochs_s);
        let left_nt: Vec<f64> =
            reading_nt.iter().zip(&anomaly_nt).map(|(reading, anomaly)| reading - anomaly).collect();
        let plain = Whitening::new(blocks, Predictor::white(1.0), None);
        let mut sums = vec![Sums::default(); self.all.len()];
        for (row, left_nt) in plain.rows().zip(plain.apply(&left_nt)) {
            let sizes_nt = self.all.iter().map(|target| target.dipole.anomaly_nt(epochs_s[row]).abs()).enumerate();
            let largest = sizes_nt.max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((target, nt)) = largest.filter(|(_, nt)| *nt > TARGET_ERROR_SIGMAS * noise_nt) {
                let sums = &mut sums[target];
                sums.rows += 1.0;
                sums.left_nt2 += left_nt * left_nt;
                sums.anomaly_nt2 += nt * nt;
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::targets::Target;
    use crate::diagnosis::targets::dipole::Dipole;

    #[test]
    fn an_error_is_that_of_what_was_read_and_of_most_where_a_target_is_weak() {
        let noise_nt = 0.05;
        let target = |epoch_s: f64, nt: f64| {
            let dipole = Dipole { epoch_s, distance_s: 2.0, amplitudes_nt: [nt, 0.0, 0.0] };
            Target { dipole, probability: 0.99, is_part: false, is_seen: true, glrt: 0.0, noise_nt, error: 0.0 }
        };
        let targets = Targets {
            all: [(60.0, 40.0), (120.0, 30.0), (180.0, 20.0), (240.0, 0.5)].map(|(s, nt)| target(s, nt)).into(),
            further: 0,
        };
        let epochs_s: Vec<f64> = (0..3000).map(|row| 0.1 * f64::from(row)).collect();
        // Each is read with a ripple of its own over it, whose rms is the error; one is as it should be.
        let ripples = [0.2, 0.05, 0.0, 0.0];
        let read = |s: &f64| {
            let one = |(target, ripple): (&Target, f64)| {
                target.dipole.anomaly_nt(*s) * (1.0 + ripple * 2_f64.sqrt() * (3.0 * s).sin())
            };
            targets.all.iter().zip(ripples).map(one).sum()
        };
        let reading_nt: Vec<f64> = epochs_s.iter().map(read).collect();
        let block = Block { rows: 0..3000, missing: Vec::new(), targets: Vec::new() };
        let found = targets.clone().with_errors(&reading_nt, noise_nt, &epochs_s, &[block]);
        let errors: Vec<f64> = found.all.iter().map(|target| target.error).collect();
        let asked = [0.2, 0.05, 0.05, 0.05];
        assert!(errors.iter().zip(asked).all(|(error, asked)| (error - asked).abs() < 0.15 * asked), "{errors:?}");
    }
}
