//! Mechanisms that are not in the library, for what the diagnosis says of the unknown. Those that judge it are others than
//! those that it is tuned with.

mod mechanism;
mod shape;
mod trial;
mod tuning;

use crate::setting::Setting;
pub(crate) use mechanism::Mechanism;

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
