//! What a recorder makes of the readings: steps that are part of any recording, in as many digits as it writes.

use rand::RngExt;

use super::state::World;
use crate::random::Random;
use crate::recorder::RecorderKind;
use crate::setting::Setting;

/// Steps of scalar and fluxgate, nT, the coarsest first: of recorders that write true digits.
const TRUE_STEPS_NT: [&[f64]; 2] = [&[0.01, 0.005, 0.002, 0.001], &[1.5, 0.5, 0.25, 0.1, 0.05]];
/// The same and those of 16-bit converters over +-100,000, +-50,000, +-5,000 and +-3,000 nT.
const PADDED_STEPS_NT: [&[f64]; 2] =
    [&[0.01, 0.005, 0.004, 0.002, 0.001], &[3.051_757_8, 1.525_878_9, 0.25, 0.152_587_9, 0.1, 0.091_552_7, 0.05]];
/// What a step may add to the noise power of its sensor, below the 2 % from which it is an effect.
const MOST_ADDED: f64 = 0.018;

/// A recorder's steps and digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Recorder {
    pub(crate) kind: RecorderKind,
    /// Of scalar and fluxgate, nT; none where the last digit is the step.
    steps_nt: Option<[f64; 2]>,
    /// Decimals of scalar and fluxgate.
    pub(super) decimals: [usize; 2],
}

impl Recorder {
    /// One of a kind, or of any, that suits the noise of a world. Where it judges, the fine ones are rarer.
    pub(crate) fn draw(kind: Option<RecorderKind>, setting: Setting, world: &World, draw: &mut Random) -> Self {
        let any = match setting {
            Setting::Tuning => RecorderKind::ALL[draw.random_range(0..RecorderKind::ALL.len())],
            Setting::Trial => RecorderKind::ALL[[0, 1, 1, 2, 2][draw.random_range(0..5_usize)]],
        };
        let kind = kind.unwrap_or(any);
        let mut steps_of = |steps_nt: [&[f64]; 2]| {
            let noise_nt = [world.noise.band_rms_nt(), world.flux_noise_nt];
            [0, 1].map(|sensor| step_nt(steps_nt[sensor], noise_nt[sensor], draw))
        };
        match kind {
            RecorderKind::Fine => Self { kind, steps_nt: None, decimals: world.columns.decimals },
            RecorderKind::Ordinary => {
                let steps_nt = steps_of(TRUE_STEPS_NT);
                Self { kind, steps_nt: Some(steps_nt), decimals: steps_nt.map(decimals) }
            }
            RecorderKind::Padded => {
                let steps_nt = steps_of(PADDED_STEPS_NT);
                Self { kind, steps_nt: Some(steps_nt), decimals: [draw.random_range(4..=6), draw.random_range(3..=6)] }
            }
        }
    }

    /// A scalar reading as it is recorded, nT.
    pub(super) fn scalar_nt(&self, nt: f64) -> f64 {
        self.steps_nt.map_or(nt, |[step_nt, _]| rounded(nt, step_nt))
    }

    /// A component of the fluxgate as it is recorded, nT.
    pub(super) fn flux_nt(&self, nt: f64) -> f64 {
        self.steps_nt.map_or(nt, |[_, step_nt]| rounded(nt, step_nt))
    }
}

fn rounded(nt: f64, step_nt: f64) -> f64 {
    step_nt * (nt / step_nt).round()
}

/// Any of the steps that add little enough to a noise, the finest where none does.
fn step_nt(steps_nt: &[f64], noise_nt: f64, draw: &mut Random) -> f64 {
    let is_ordinary = |step_nt: &&f64| *step_nt * *step_nt / 12.0 < MOST_ADDED * noise_nt * noise_nt;
    let ordinary: Vec<f64> = steps_nt.iter().filter(is_ordinary).copied().collect();
    let finest = steps_nt[steps_nt.len() - 1];
    if ordinary.is_empty() { finest } else { ordinary[draw.random_range(0..ordinary.len())] }
}

/// Decimals that multiples of a step need.
fn decimals(step_nt: f64) -> usize {
    let is_whole = |decimals: &usize| {
        let scaled = step_nt * 10_f64.powi(*decimals as i32);
        (scaled - scaled.round()).abs() < 1e-9
    };
    (0..6).find(is_whole).unwrap_or(6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn worlds() -> impl Iterator<Item = World> {
        (0..20).map(|k| {
            World::draw(1200, Setting::Trial, &mut Random::seed_from_u64(k), &mut Random::seed_from_u64(k + 100))
        })
    }

    #[test]
    fn steps_add_less_than_an_effect_and_are_written_with_digits_enough() {
        for (seed, world) in worlds().enumerate() {
            for kind in [RecorderKind::Ordinary, RecorderKind::Padded] {
                let recorder =
                    Recorder::draw(Some(kind), Setting::Trial, &world, &mut Random::seed_from_u64(seed as u64));
                let steps_nt = recorder.steps_nt.unwrap();
                let noise_nt = [world.noise.band_rms_nt(), world.flux_noise_nt];
                for sensor in [0, 1] {
                    let (step_nt, last_digit_nt) = (steps_nt[sensor], 0.1_f64.powi(recorder.decimals[sensor] as i32));
                    assert!(step_nt * step_nt / 12.0 < 0.02 * noise_nt[sensor].powi(2), "{step_nt}");
                    assert!(step_nt > (if kind == RecorderKind::Padded { 5.0 } else { 0.99 }) * last_digit_nt);
                }
                let nt = 31_234.567_89;
                let steps = recorder.flux_nt(nt) / steps_nt[1];
                assert!((steps - steps.round()).abs() < 1e-6 && (recorder.flux_nt(nt) - nt).abs() <= 0.5 * steps_nt[1]);
            }
        }
    }

    #[test]
    fn a_fine_recorder_writes_what_it_is_given() {
        let world = worlds().next().unwrap();
        let recorder = Recorder::draw(Some(RecorderKind::Fine), Setting::Trial, &world, &mut Random::seed_from_u64(1));
        assert_eq!((recorder.scalar_nt(0.123_456), recorder.flux_nt(0.123_456)), (0.123_456, 0.123_456));
        assert_eq!(recorder.decimals, world.columns.decimals);
    }

    #[test]
    fn true_digits_are_those_that_a_step_needs() {
        assert_eq!([1.5, 0.5, 0.25, 0.05, 0.002].map(decimals), [1, 1, 2, 2, 3]);
    }
}
