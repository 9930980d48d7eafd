//! What is put into a real recording, and putting it in.

use rand::RngExt;

use super::recording::RealRecording;
use crate::answer::{Answer, Hidden, Kind};
use crate::options::TrialOptions;
use crate::random::{Random, stream};
use crate::sizing::sized;
use crate::strength::STRENGTHS;
use crate::world::effects::{self, Effect};
use crate::world::target::{self, Dipole};

/// Parameters until an effect reaches its strength.
const TRIES: usize = 6;
/// How far the peaks of targets are above the recording's own residual at least, nT.
const LEAST_TARGET_NT: f64 = 5.0;
/// How far beyond what is plausible a parameter may go: a real recording is louder than noise.
const STRETCH: f64 = 3.0;

/// Draw what is put in; none where it would not show. Each effect comes with each strength before any comes twice.
pub(crate) fn answer(options: &TrialOptions, real: &RealRecording, index: usize) -> Option<Answer> {
    let count = real.effects.len();
    let most = (index / count + index) % STRENGTHS.len();
    let hidden = hidden(options, real, real.effects[index % count], most, index)?;
    let [noise_rms_nt, fluxgate_noise_rms_nt] = real.residual_rms_nt();
    Some(Answer {
        index,
        kind: Kind::Single,
        minutes: real.world.rows() as f64 / 600.0,
        motion: real.world.motion().into(),
        noise: "recorded".into(),
        noise_rms_nt,
        fluxgate_noise_rms_nt,
        recorder: "recorded".into(),
        world: 0,
        drivers: Vec::new(),
        is_random: false,
        hidden: vec![hidden],
        targets: dipoles(options, real, index).iter().map(|dipole| dipole.seen).collect(),
    })
}

/// On a loud recording some effects do not reach every strength: then the next lower one.
fn hidden(
    options: &TrialOptions,
    RealRecording { world, .. }: &RealRecording,
    effect: &Effect,
    most: usize,
    index: usize,
) -> Option<Hidden> {
    let mut draw = random(options, index, 0);
    STRENGTHS[..=most].iter().rev().find_map(|aim| {
        (0..TRIES).find_map(|_| {
            let aim = aim * draw.random_range(0.8..1.2);
            sized(world, effect, effect.drawn(world, &mut draw)?, aim, STRETCH, || random(options, index, 1))
        })
    })
}

/// The recording with what an answer puts in, as the text of a CSV file.
pub(crate) fn injected(options: &TrialOptions, real: &RealRecording, answer: &Answer) -> String {
    let world = real.world.clone().with_targets(&dipoles(options, real, answer.index));
    let (changes, last) = effects::changes(&world, &answer.hidden, &[], |_| random(options, answer.index, 1));
    real.with_readings(&world.record(&changes, last, &mut random(options, answer.index, 2)))
}

/// Targets that stand out of what the 18 terms leave.
fn dipoles(options: &TrialOptions, real: &RealRecording, index: usize) -> Vec<Dipole> {
    let [floor_nt, _] = real.residual_rms_nt();
    target::draw_large(&real.world, LEAST_TARGET_NT + floor_nt, &mut random(options, index, 3))
}

fn random(options: &TrialOptions, index: usize, purpose: u64) -> Random {
    stream(options.seed, ((index as u64) << 8) | purpose)
}
