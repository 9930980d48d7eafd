//! The effects of the trial: names, parameters and what they do as the project's contract words them, nothing else.
//! `firmware_mismatch` is not among them: it is in a log, not in a recording.

mod depth;
mod effect;
mod fluxgate;
mod moment;
mod optical;
mod own;
mod platform;
mod timing;

use super::readings::{Change, Last};
use super::state::World;
use crate::answer::Hidden;
use crate::random::Random;
pub(crate) use effect::{Channel, Effect, Parameters};
pub(crate) use own::of_file;
pub(super) use timing::read_late;

/// All of them.
pub(crate) fn all() -> impl Iterator<Item = &'static Effect> {
    timing::EFFECTS
        .iter()
        .chain(&optical::EFFECTS)
        .chain(&fluxgate::EFFECTS)
        .chain(&moment::EFFECTS)
        .chain(&platform::EFFECTS)
        .chain(&depth::EFFECTS)
}

/// What the effects among those hidden change, and what they do last; `draw` gives the chance of each slot.
pub(crate) fn changes(
    world: &World,
    hidden: &[Hidden],
    own: &[&'static Effect],
    draw: impl Fn(usize) -> Random,
) -> (Vec<Change>, Vec<(Last, Random)>) {
    let (mut changes, mut last) = (Vec::new(), Vec::new());
    for (slot, hidden) in hidden.iter().enumerate() {
        let Some(effect) = named(&hidden.name, own) else { continue };
        changes.push(effect.change(world, &hidden.parameters, &mut draw(slot)));
        last.extend(effect.last(&hidden.parameters).map(|last| (last, draw(slot))));
    }
    (changes, last)
}

/// The effect of a name, of the trial or of a user.
pub(crate) fn named(name: &str, own: &[&'static Effect]) -> Option<&'static Effect> {
    all().chain(own.iter().copied()).find(|effect| effect.name == name)
}
