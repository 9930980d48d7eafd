//! The effects of the trial: names, parameters and what they do as the project's contract words them, nothing else.
//! `firmware_mismatch` is not among them: it is in a log, not in a recording.

mod depth;
mod effect;
mod fluxgate;
mod moment;
mod optical;
mod platform;
mod timing;

pub(crate) use effect::{Channel, Effect, Parameters};
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

/// The effect of a name.
pub(crate) fn named(name: &str) -> Option<&'static Effect> {
    all().find(|effect| effect.name == name)
}
