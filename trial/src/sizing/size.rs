//! How strong an effect is, and making it as strong as it shall be.

use super::background::{rms, without_background};
use super::difference::difference_nt;
use super::identifiable::{identifiable, of_change};
use crate::answer::Hidden;
use crate::random::Random;
use crate::world::effects::{Channel, Effect, Parameters};
use crate::world::foreign::Mechanism;
use crate::world::{BAND_HZ, Change, World};

/// How far from the strength asked for, as a logarithm.
const CLOSE: f64 = 0.02;
/// A mechanism that changes less than this at unit size does nothing, nT rms.
const NOTHING: f64 = 1e-9;
/// How far where the effect has steps.
const NEAR: f64 = 0.4;

/// The effect with parameters that make it this strong here; none where that takes more than `stretch` times what is
/// plausible.
pub(crate) fn sized(
    world: &World,
    effect: &Effect,
    mut parameters: Parameters,
    aim: f64,
    stretch: f64,
    draws: impl Fn() -> Random,
) -> Option<Hidden> {
    let mut strength = strength(world, effect, &parameters, &draws);
    for _ in 0..10 {
        if effect.sizes.is_empty() || strength <= 0.0 || (aim / strength).ln().abs() < CLOSE {
            break;
        }
        // The power of repeats, not their rms, grows with their number.
        let power = if effect.name == "stale_sample" { 2.0 } else { 1.0 };
        let by = libm::pow(aim / strength, power).clamp(1e-3, 1e3).min(stretch * effect.room(&parameters));
        effect.sizes.iter().for_each(|name| *parameters.get_mut(*name).expect("a parameter of the effect") *= by);
        strength = self::strength(world, effect, &parameters, &draws);
    }
    let tolerance = if effect.sizes.is_empty() { NEAR } else { 2.0 * CLOSE };
    let is_reached = strength > 0.0 && (aim / strength).ln().abs() < tolerance;
    is_reached.then(|| {
        let identifiable = identifiable(world, effect, &parameters, &draws);
        Hidden { name: effect.name.into(), load: load(world, effect, &parameters), parameters, strength, identifiable }
    })
}

/// The load whose recorded current drives an effect: one without a period.
fn load(world: &World, effect: &Effect, parameters: &Parameters) -> Option<String> {
    let is_recorded = effect.name == "load_current" && !parameters.contains_key("period_s");
    world.load().filter(|_| is_recorded).map(String::from)
}

/// Rms of what it changes over that of the noise, both without the slow background.
fn strength(world: &World, effect: &Effect, parameters: &Parameters, draws: &impl Fn() -> Random) -> f64 {
    rms(&without_background(&difference_nt(world, effect, parameters, draws))) / noise_rms_nt(world, effect.channel)
}

/// Of the scalar, or of the fluxgate's magnitude, nT.
fn noise_rms_nt(world: &World, channel: Channel) -> f64 {
    match channel {
        Channel::Scalar => world.noise.band_rms_nt(),
        Channel::Fluxgate => world.flux_noise_nt * (1.0 - BAND_HZ[0] / BAND_HZ[1]).sqrt(),
    }
}

/// What a mechanism changes in one sensor at unit size.
fn of_unit(world: &World, change: &Change, channel: Channel) -> Vec<f64> {
    if channel == Channel::Scalar {
        return change.scalar_nt.clone();
    }
    let along = |(c, nt): (&[f64; 3], &[f64; 3])| (0..3).map(|k| c[k] * nt[k]).sum();
    world.directions().iter().zip(&change.flux_nt).map(along).collect()
}

/// A mechanism outside the library with its size: nT at unit size; none where the world has not what it acts on.
pub(crate) fn sized_mechanism(
    world: &World,
    mechanism: &Mechanism,
    aim: f64,
    draws: impl Fn() -> Random,
) -> Option<Hidden> {
    let change = (mechanism.change)(world, &mut draws());
    let channel = if change.scalar_nt.is_empty() { Channel::Fluxgate } else { Channel::Scalar };
    let unit = of_unit(world, &change, channel);
    let rms = rms(&without_background(&unit));
    let size = aim * noise_rms_nt(world, channel) / rms;
    (rms > NOTHING).then(|| Hidden {
        name: mechanism.name.into(),
        load: None,
        parameters: [("size_nT".to_string(), size)].into(),
        strength: aim,
        identifiable: of_change(world, channel, &unit.iter().map(|nt| size * nt).collect::<Vec<f64>>()),
    })
}
