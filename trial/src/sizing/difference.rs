//! What an effect changes.

use crate::random::Random;
use crate::world::effects::{Channel, Effect, Parameters};
use crate::world::{Readings, World, magnitudes};

/// What it changes in the scalar or in the fluxgate's magnitude, nT.
pub(super) fn difference_nt(
    world: &World,
    effect: &Effect,
    parameters: &Parameters,
    draws: &impl Fn() -> Random,
) -> Vec<f64> {
    match effect.last(parameters) {
        // What is done to the noise as well is seen in noisy readings.
        Some(last) => {
            let with = world.record(&[], vec![(last, draws())], &mut draws());
            let without = world.record(&[], Vec::new(), &mut draws());
            less(&with, &without, effect.channel)
        }
        None => {
            let clean = world.clean();
            let mut with = clean.clone();
            with.add(&effect.change(world, parameters, &mut draws()));
            less(&with, &clean, effect.channel)
        }
    }
}

fn less(a: &Readings, b: &Readings, channel: Channel) -> Vec<f64> {
    let (a, b) = match channel {
        Channel::Scalar => (a.scalar_nt.clone(), b.scalar_nt.clone()),
        Channel::Fluxgate => (magnitudes(&a.flux_nt), magnitudes(&b.flux_nt)),
    };
    a.iter().zip(&b).map(|(a, b)| a - b).collect()
}
