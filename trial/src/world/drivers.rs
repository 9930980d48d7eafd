//! What drives an effect or a mechanism, of what a recording has: written down before any diagnosis was held against it.

#[cfg(test)]
use super::effects;
use super::foreign;
use super::state::World;
use crate::answer::Hidden;

/// Effects of the library with the inputs that drive them, any of which is right. The others live in time or by chance.
const OF_EFFECTS: [(&str, &[&str]); 16] = [
    ("scalar_lag", &["reading"]),
    ("clock_drift", &["reading", "time_irregular"]),
    ("sample_slip", &["reading", "time_irregular"]),
    ("averaging_window", &["reading"]),
    ("scalar_lowpass", &["reading"]),
    ("heading_error", &["attitude"]),
    ("fluxgate_bias", &["attitude"]),
    ("fluxgate_scale", &["attitude"]),
    ("fluxgate_nonorthogonality", &["attitude"]),
    ("fluxgate_nonlinearity", &["attitude"]),
    ("fluxgate_temperature_drift", &["temperature"]),
    ("permanent_temperature", &["temperature"]),
    ("second_order", &["attitude", "reading"]),
    ("eddy_lag", &["attitude_rate", "attitude_history"]),
    ("depth_gradient", &["depth"]),
    ("swell_induction", &["depth_rate", "depth"]),
];
/// Effects that are random from row to row.
const RANDOM: [&str; 4] = ["sample_jitter", "stale_sample", "dead_zone", "fluxgate_quantisation"];

/// Inputs that drive what is hidden, any of which is right; empty where none was recorded.
pub(crate) fn of(world: &World, hidden: &Hidden) -> Vec<String> {
    let named = |names: &[&str]| -> Vec<String> {
        let is_there = |name: &&&str| world.columns.has_depth || !name.starts_with("depth");
        names.iter().filter(is_there).map(|name| (*name).to_string()).collect()
    };
    if let Some(load) = &hidden.load {
        return vec![format!("current_{load}_A")];
    }
    if let Some(mechanism) = foreign::named(&hidden.name) {
        return named(mechanism.drivers);
    }
    let own = OF_EFFECTS.iter().find(|(name, _)| *name == hidden.name);
    own.map_or_else(Vec::new, |(_, drivers)| named(drivers))
}

/// Whether a part of what is hidden is chance, which no shape of a driver can follow.
pub(crate) fn is_random(hidden: &Hidden) -> bool {
    let is_random = foreign::named(&hidden.name).is_some_and(|mechanism| mechanism.is_random);
    is_random || RANDOM.contains(&hidden.name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_with_a_driver_is_one_of_the_library() {
        for (name, drivers) in OF_EFFECTS {
            assert!(effects::named(name, &[]).is_some() && !drivers.is_empty() && !RANDOM.contains(&name), "{name}");
        }
        assert!(RANDOM.iter().all(|name| effects::named(name, &[]).is_some()));
    }
}
