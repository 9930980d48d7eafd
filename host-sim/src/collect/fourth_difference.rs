//! Noise from row to row by fourth differences: what is smooth over half a second cancels.

use super::continuity::Continuity;
use super::running_std::RunningStd;

/// Squares of the binomial weights 1, 4, 6, 4, 1, summed: white noise of unit size gives fourth differences of its root.
const WHITE_GAIN_SQUARED: f64 = 70.0;

/// Standard deviation of the fourth differences over the root of 70: that of the noise, where it is white. Industry takes
/// it as the figure of a magnetometer's noise (Coyle and others, Canadian aeromagnetic surveys, 2014).
#[derive(Clone, Copy, Debug, Default)]
pub struct FourthDifference {
    last: [f64; 4],
    held: usize,
    continuity: Continuity,
    differences: RunningStd,
}

impl FourthDifference {
    /// Take in one sample. Nothing is taken across a gap, or across a value that is not finite.
    pub fn push(&mut self, time_s: f64, value: f64) {
        if self.continuity.after_gap(time_s) || !value.is_finite() {
            self.held = 0;
        }
        if !value.is_finite() {
            return;
        }
        let [a, b, c, d] = self.last;
        if self.held == self.last.len() {
            // Neighbours first: their differences are exact where the level is large.
            self.differences.push((value - d) - 3.0 * (d - c) + 3.0 * (c - b) - (b - a));
        }
        self.last = [b, c, d, value];
        self.held = (self.held + 1).min(self.last.len());
    }

    /// The figure, nT; `None` before five samples in a row.
    pub fn std(&self) -> Option<f64> {
        (self.differences.count() > 0).then(|| self.differences.std() / WHITE_GAIN_SQUARED.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn of(values: impl Iterator<Item = f64>) -> Option<f64> {
        let mut collector = FourthDifference::default();
        values.enumerate().for_each(|(i, value)| collector.push(0.1 * i as f64, value));
        collector.std()
    }

    #[test]
    fn a_cubic_has_none_and_an_alternation_has_sixteen_over_root_seventy() {
        let cubic = of((0..100).map(|i| 50_000.0 + f64::from(i).powi(3) * 1e-3)).unwrap();
        assert!(cubic < 1e-6, "{cubic}");
        let alternating = of((0..1001).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })).unwrap();
        assert!((alternating - 16.0 / 70_f64.sqrt()).abs() < 1e-2, "{alternating}");
    }

    #[test]
    fn white_noise_gives_itself() {
        let white = StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(1)).take(50_000);
        let found = of(white).unwrap();
        assert!((found - 1.0).abs() < 0.03, "{found}");
    }

    #[test]
    fn nothing_is_taken_across_a_gap() {
        let mut collector = FourthDifference::default();
        for i in 0..8 {
            collector.push(0.1 * f64::from(i) + if i < 4 { 0.0 } else { 60.0 }, 1000.0 * f64::from(i / 4));
        }
        assert_eq!(collector.std(), None);
    }
}
