//! `stale_sample`: each row repeats the scalar reading of the row before with some probability.

use rand::RngExt;

use super::parts::real;
use crate::effects::{Change, Draw, Effect, Kind, Parameter, Readings, Search, Spec};
use crate::simulator::signals::Signals;

/// The effect `stale_sample`.
#[derive(Debug)]
pub struct StaleSample;

const PARAMETERS: &[Parameter] = &[real("probability", "", [0.0, 1.0], [0.0005, 0.3], Kind::Searched)];

/// Repeats in a row that the variance counts: beyond them nothing is left at any plausible probability.
const LONGEST_RUN: usize = 12;

const SPEC: Spec = Spec {
    name: "stale_sample",
    title: "repeated scalar readings",
    what: "now and then a scalar reading is that of the row before, noise and all",
    origin: "the logger's tick finds no new sentence and takes the last one again",
    source: "two free-running 10 Hz clocks that differ by 100 ppm repeat one in 10,000; polling repeats far more",
    model: "a row repeats the scalar reading of the row before",
    parameters: PARAMETERS,
    random: true,
    search: Search::ExactRepeats,
    injectable: true,
    ..Spec::BASE
};

impl Effect for StaleSample {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, _: &Signals, _: &[f64], _: &mut Draw) -> Change {
        Change::default()
    }

    /// The reading with its noise is what is repeated, but none from before a gap.
    fn after_noise(&self, signals: &Signals, parameters: &[f64], readings: &mut Readings, draw: &mut Draw) {
        for segment in signals.segments() {
            for row in segment.epochs.clone() {
                // Drawn for every row, so that a stronger effect repeats the same rows and more.
                let repeats = draw.random::<f64>() < parameters[0];
                if repeats && row > segment.epochs.start {
                    readings.scalar_nt[row] = readings.scalar_nt[row - 1];
                }
            }
        }
    }

    /// Of the clean signal: the mean over runs of repeats.
    fn variance(&self, signals: &Signals, parameters: &[f64]) -> Option<Change> {
        let (probability, s_nt) = (parameters[0], signals.scalar_at_rows_nt());
        let mut variance = Vec::with_capacity(signals.len());
        for segment in signals.segments() {
            for row in segment.epochs.clone() {
                let longest = (row - segment.epochs.start).min(LONGEST_RUN);
                let (mut sum, mut chance) = (0.0, 1.0);
                for run in 1..=longest {
                    chance *= probability;
                    let ends = if run == longest { 1.0 } else { 1.0 - probability };
                    sum += chance * ends * (s_nt[row - run] - s_nt[row]).powi(2);
                }
                variance.push(sum);
            }
        }
        Some(Change::of_scalar(variance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulator::signals::tests::{signals, signals_of, trajectory};
    use rand::SeedableRng;

    fn numbered(signals: &Signals) -> Readings {
        Readings { scalar_nt: (0..signals.len()).map(|k| k as f64).collect(), flux_nt: Vec::new() }
    }

    #[test]
    fn the_share_of_repeats_is_the_probability_and_none_crosses_a_gap() {
        let mut trajectory = trajectory();
        trajectory.epochs_s.drain(200..210);
        let signals = signals_of(trajectory);
        let mut repeats = 0;
        for seed in 0..50 {
            let mut readings = numbered(&signals);
            StaleSample.after_noise(&signals, &[0.2], &mut readings, &mut Draw::seed_from_u64(seed));
            repeats += readings.scalar_nt.windows(2).filter(|pair| pair[0] == pair[1]).count();
            assert_eq!((readings.scalar_nt[0], readings.scalar_nt[200]), (0.0, 200.0));
        }
        let share = repeats as f64 / (50.0 * 588.0);
        assert!((share - 0.2).abs() < 0.01, "{share}");
    }

    #[test]
    fn the_variance_is_that_of_many_draws() {
        let signals = signals();
        let clean_nt = signals.scalar_at_rows_nt();
        let (mut found, draws) = (0.0, 300);
        for seed in 0..draws {
            let mut readings = Readings { scalar_nt: clean_nt.to_vec(), flux_nt: Vec::new() };
            StaleSample.after_noise(&signals, &[0.1], &mut readings, &mut Draw::seed_from_u64(seed));
            found += readings.scalar_nt.iter().zip(clean_nt).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        }
        let expected: f64 = StaleSample.variance(&signals, &[0.1]).unwrap().scalar_nt.iter().sum();
        assert!((found / draws as f64 / expected - 1.0).abs() < 0.05);
    }
}
