//! How often two readings come out the same by chance, for a recorder that rounds: from the distribution of their
//! difference.

use statrs::function::erf::erfc;

use crate::diagnosis::numerics::{golden_section_minimum, median};
use crate::diagnosis::policy::{CHANCE_OF_REPEAT, REPEAT_LEAST_STEP_SHARE};

/// Rows that the spread is fitted to, at most.
const MOST_FITTED: usize = 4000;
/// Share of changes that may be of another, wider distribution, and how many times wider that is.
const WIDER_SHARE: f64 = 0.02;
const WIDER: f64 = 10.0;
/// The spread that fits best, over the one of the changes alone, and the logarithm to which it is found.
const SPREAD_RATIOS: [f64; 2] = [0.08, 2.0];
const LOG_TOLERANCE: f64 = 0.02;
/// Step over spread below which a density is as good as a difference of integrals, and keeps its digits.
const FINE: f64 = 1e-4;
/// Standard deviations up to which a change is next to none: where noise is loud only at times, most of what is small is of
/// the quiet times.
const NEXT_TO_NONE: f64 = 0.2;
/// Standard deviations by which the chance is taken to be larger than the changes of few steps say.
const DOUBT: f64 = 2.0;

/// A row that follows another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    /// What the reading changed by, nT.
    pub(super) read_nt: f64,
    /// What the model expects, nT.
    pub(super) expected_nt: f64,
    /// What readings are rounded to, nT.
    pub(super) step_nt: f64,
}

/// What readings change by from row to row beside what the model expects.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    /// Standard deviation before rounding, nT.
    pub(super) std_nt: f64,
    /// How many times as likely as from a normal distribution a small change is.
    centre: f64,
}

impl Spread {
    /// Of changes, of which at least one is not 0.
    pub(super) fn of(changes: &[Change]) -> Self {
        let std_nt = std_nt(changes);
        Self { std_nt, centre: centre(changes, std_nt) }
    }

    /// Chance that a reading repeats the one before by itself.
    pub(super) fn chance_of_repeat(&self, change: &Change) -> f64 {
        let chance = self.centre * chance(&Change { read_nt: 0.0, ..*change }, self.std_nt);
        chance.clamp(CHANCE_OF_REPEAT[0], CHANCE_OF_REPEAT[1])
    }
}

/// Chance to read a change that is normal about the expected one: both readings are rounded, each from anywhere within a
/// step, so that the change before rounding is off by a triangular variable.
fn chance(change: &Change, std_nt: f64) -> f64 {
    let step = change.step_nt / std_nt;
    let at = -((change.read_nt - change.expected_nt) / std_nt).abs();
    if step < FINE {
        return step * density(at);
    }
    ((twice_integrated(at + step) - 2.0 * twice_integrated(at) + twice_integrated(at - step)) / step).max(0.0)
}

fn density(x: f64) -> f64 {
    (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
}

/// The normal density, integrated twice.
fn twice_integrated(x: f64) -> f64 {
    x * 0.5 * erfc(-x * std::f64::consts::FRAC_1_SQRT_2) + density(x)
}

/// The likeliest standard deviation, repeats among the changes: they count as chance as far as it can explain them.
fn std_nt(changes: &[Change]) -> f64 {
    let is_changed = |change: &&Change| change.read_nt != 0.0;
    let off_nt = |change: &Change| (change.read_nt - change.expected_nt).abs();
    let middle_nt = median(changes.iter().filter(is_changed).map(off_nt).collect()) / 0.6745;
    let step_nt = median(changes.iter().map(|change| change.step_nt).collect());
    let start_nt = middle_nt.max(REPEAT_LEAST_STEP_SHARE * step_nt);
    let fitted: Vec<&Change> = changes.iter().step_by(changes.len().div_ceil(MOST_FITTED)).collect();
    let surprise = |log_std: f64| -> f64 {
        let std_nt = log_std.exp();
        let of = |change: &&Change| {
            (1.0 - WIDER_SHARE) * chance(change, std_nt) + WIDER_SHARE * chance(change, WIDER * std_nt)
        };
        -fitted.iter().map(|change| of(change).max(f64::MIN_POSITIVE).ln()).sum::<f64>()
    };
    golden_section_minimum(surprise, SPREAD_RATIOS.map(|ratio| (ratio * start_nt).ln()), LOG_TOLERANCE).exp()
}

/// Changes of one step and more that are next to none, over those that a normal distribution would make: they tell how often
/// none comes by chance, whatever the distribution. Never below 1, and as large as the count leaves in doubt.
fn centre(changes: &[Change], std_nt: f64) -> f64 {
    let (mut there, mut expected) = (0.0, 0.0);
    for change in changes {
        let most_steps = (NEXT_TO_NONE * std_nt / change.step_nt).floor().max(1.0);
        if change.read_nt != 0.0 && change.read_nt.abs() < (most_steps + 0.5) * change.step_nt {
            there += 1.0;
        }
        expected += chance_of_few(change, most_steps, std_nt);
    }
    ((there + DOUBT * f64::sqrt(there + 1.0)) / expected.max(1.0)).max(1.0)
}

/// Chance to read a change of at least one and at most so many steps: the sum of [`chance`], of which all but the ends
/// cancel.
fn chance_of_few(change: &Change, most_steps: f64, std_nt: f64) -> f64 {
    let at = |steps: f64| twice_integrated((steps * change.step_nt - change.expected_nt) / std_nt);
    let all = at(most_steps + 1.0) - at(most_steps) - at(-most_steps) + at(-most_steps - 1.0);
    let none = chance(&Change { read_nt: 0.0, ..*change }, std_nt);
    (all * std_nt / change.step_nt - none).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    fn rounded(nt: f64, step_nt: f64) -> f64 {
        (nt / step_nt).round() * step_nt
    }

    /// Changes of a reading that drifts by `expected_nt` a row, with white noise of a size that alternates between two.
    fn changes(step_nt: f64, expected_nt: f64, noise_nt: [f64; 2], seed: u64) -> Vec<Change> {
        let draw = &mut ChaCha8Rng::seed_from_u64(seed);
        let phase_nt: f64 = draw.random();
        let noise = noise_nt.map(|std_nt| Normal::new(0.0, std_nt).unwrap());
        let readings: Vec<f64> = (0..6000)
            .map(|k| {
                rounded(phase_nt + expected_nt * f64::from(k) + noise[(k as usize / 300) % 2].sample(draw), step_nt)
            })
            .collect();
        readings.windows(2).map(|pair| Change { read_nt: pair[1] - pair[0], expected_nt, step_nt }).collect()
    }

    fn repeats(changes: &[Change]) -> f64 {
        changes.iter().filter(|change| change.read_nt.abs() < 1e-9).count() as f64
    }

    #[test]
    fn all_chances_make_one_and_few_are_the_sum_of_each() {
        for step_nt in [0.01, 0.3, 2.0, 9.0] {
            let change = |steps: f64| Change { read_nt: steps * step_nt, expected_nt: 0.7, step_nt };
            let most = (12.0_f64 / step_nt).ceil();
            let sum: f64 = (-most as i32..=most as i32).map(|steps| chance(&change(f64::from(steps)), 1.0)).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{step_nt}: {sum}");
            let few: f64 = [-2.0, -1.0, 1.0, 2.0].iter().map(|&steps| chance(&change(steps), 1.0)).sum();
            assert!((chance_of_few(&change(0.0), 2.0, 1.0) - few).abs() < 1e-9, "{step_nt}");
        }
    }

    #[test]
    fn as_many_repeats_are_expected_as_there_are() {
        for (seed, step_nt) in [0.001, 0.01, 0.05, 0.15, 0.4].into_iter().enumerate() {
            for expected_nt in [0.002, 0.03, 0.1] {
                let changes = changes(step_nt, expected_nt, [0.05, 0.05], seed as u64);
                let spread = Spread::of(&changes);
                let expected: f64 = changes.iter().map(|change| spread.chance_of_repeat(change)).sum();
                let there = repeats(&changes);
                assert!(there < expected + 4.0 * expected.sqrt() + 1.0, "{step_nt} {expected_nt}: {there} {expected}");
                assert!(there > 0.7 * expected - 4.0 * expected.sqrt(), "{step_nt} {expected_nt}: {there} {expected}");
            }
        }
    }

    #[test]
    fn noise_that_is_loud_at_times_is_not_taken_for_repeats() {
        let changes = changes(0.01, 0.002, [0.03, 0.2], 7);
        let spread = Spread::of(&changes);
        let expected: f64 = changes.iter().map(|change| spread.chance_of_repeat(change)).sum();
        assert!(repeats(&changes) < 1.2 * expected, "{} {expected}", repeats(&changes));
    }
}
