//! All effects by name, and what `--effect` says.

use super::effect::Effect;
use super::effects;
use super::signals::Signals;

/// Every effect that has a forward model, in the order of the documentation.
pub fn library() -> Vec<Box<dyn Effect>> {
    vec![
        Box::new(effects::ScalarLag),
        Box::new(effects::ClockDrift),
        Box::new(effects::SampleSlip),
        Box::new(effects::SampleJitter),
        Box::new(effects::StaleSample),
        Box::new(effects::AveragingWindow),
        Box::new(effects::ScalarLowpass),
        Box::new(effects::HeadingError),
        Box::new(effects::DeadZone),
        Box::new(effects::MainsAlias),
        Box::new(effects::FluxgateBias),
        Box::new(effects::FluxgateScale),
        Box::new(effects::FluxgateNonorthogonality),
        Box::new(effects::FluxgateTemperatureDrift),
        Box::new(effects::FluxgateNonlinearity),
        Box::new(effects::FluxgateQuantisation),
        Box::new(effects::PermanentStep),
        Box::new(effects::PermanentTemperature),
        Box::new(effects::SecondOrder),
        Box::new(effects::EddyLag),
        Box::new(effects::LoadCurrent::default()),
        Box::new(effects::DepthGradient),
        Box::new(effects::SwellInduction),
    ]
}

/// Those that make sense on a recording; `load_current` once more for each recorded current.
pub fn library_for(signals: &Signals) -> Vec<Box<dyn Effect>> {
    let loads = signals.world().currents_a.iter();
    let driven = loads.map(|(load, _)| Box::new(effects::LoadCurrent { load: Some(load.clone()) }) as Box<dyn Effect>);
    library().into_iter().filter(|effect| effect.applies_to(signals)).chain(driven).collect()
}

/// Found by comparing the device's outputs with a replay; it has no forward model.
pub const FIRMWARE_MISMATCH: &str = "firmware_mismatch";
