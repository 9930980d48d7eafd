//! All effects by name, and what `--effect` says.

use super::effect::Effect;
use super::effects;
use super::signals::Signals;

/// Every effect that has a forward model, in the order of the documentation.
pub fn library() -> Vec<Box<dyn Effect>> {
    vec![
        Box::new(effects::ScalarLag),
        Box::new(effects::ClockDrift),
        Box::new(effects::AveragingWindow),
        Box::new(effects::ScalarLowpass),
    ]
}

/// Those that make sense on a recording.
pub fn library_for(signals: &Signals) -> Vec<Box<dyn Effect>> {
    library().into_iter().filter(|effect| effect.applies_to(signals)).collect()
}

/// Found by comparing the device's outputs with a replay; it has no forward model.
pub const FIRMWARE_MISMATCH: &str = "firmware_mismatch";
