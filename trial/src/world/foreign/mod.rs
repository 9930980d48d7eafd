//! Mechanisms that are not in the library, for what the diagnosis says of the unknown. Those that judge it are others than
//! those that it is tuned with.

mod shape;
mod trial;
mod tuning;

use super::{Change, World};
use crate::random::Random;
use crate::setting::Setting;

/// One of them.
pub(crate) struct Mechanism {
    /// Not that of an effect.
    pub(crate) name: &'static str,
    /// At unit size; without a change where the world has not what it acts on.
    pub(crate) change: fn(&World, &mut Random) -> Change,
}

/// All of a setting.
pub(crate) fn all(setting: Setting) -> Vec<&'static Mechanism> {
    match setting {
        Setting::Tuning => tuning::ALL.iter().collect(),
        Setting::Trial => trial::all().collect(),
    }
}

/// The mechanism of a name, of any setting.
pub(crate) fn named(name: &str) -> Option<&'static Mechanism> {
    tuning::ALL.iter().chain(trial::all()).find(|mechanism| mechanism.name == name)
}

const fn mechanism(name: &'static str, change: fn(&World, &mut Random) -> Change) -> Mechanism {
    Mechanism { name, change }
}
