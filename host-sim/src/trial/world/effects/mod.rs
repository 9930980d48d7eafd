//! The effects of the trial: names, parameters and what they do as the project's contract words them, nothing else.
//! `firmware_mismatch` is not among them: it is in a log, not in a recording.

mod depth;
mod fluxgate;
mod moment;
mod optical;
mod platform;
mod timing;

use std::collections::BTreeMap;

use rand::RngExt;

use super::vector::Vector;
use super::{Change, Draw, Last, World};

/// By name, in the units of the name.
pub(in crate::trial) type Parameters = BTreeMap<String, f64>;

/// The sensor whose reading an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::trial) enum Channel {
    Scalar,
    Fluxgate,
}

/// What an effect does to a recording.
pub(in crate::trial) enum Act {
    /// To the clean scalar, nT at each row.
    Scalar(fn(&World, &Parameters, &mut Draw) -> Vec<f64>),
    /// To the clean fluxgate.
    Fluxgate(fn(&World, &Parameters) -> Vec<Vector>),
    /// To the readings when all else is done.
    Last(fn(&Parameters) -> Last),
}

/// One effect.
pub(in crate::trial) struct Effect {
    pub(in crate::trial) name: &'static str,
    pub(in crate::trial) channel: Channel,
    /// The parameters that make it larger or smaller, and the largest that each may be; none where it has steps.
    pub(in crate::trial) sizes: &'static [&'static str],
    pub(in crate::trial) most: f64,
    /// Parameters of any size; none where this world has not what the effect acts on.
    pub(in crate::trial) draw: fn(&World, &mut Draw) -> Option<Parameters>,
    pub(in crate::trial) act: Act,
}

/// All of them.
pub(in crate::trial) fn all() -> impl Iterator<Item = &'static Effect> {
    timing::EFFECTS
        .iter()
        .chain(&optical::EFFECTS)
        .chain(&fluxgate::EFFECTS)
        .chain(&moment::EFFECTS)
        .chain(&platform::EFFECTS)
        .chain(&depth::EFFECTS)
}

/// The effect of a name.
pub(in crate::trial) fn named(name: &str) -> Option<&'static Effect> {
    all().find(|effect| effect.name == name)
}

impl Effect {
    /// What it adds to the clean readings.
    pub(in crate::trial) fn change(&self, world: &World, parameters: &Parameters, draw: &mut Draw) -> Change {
        match self.act {
            Act::Scalar(of) => Change { scalar_nt: of(world, parameters, draw), ..Change::default() },
            Act::Fluxgate(of) => Change { flux_nt: of(world, parameters), ..Change::default() },
            Act::Last(_) => Change::default(),
        }
    }

    /// What it does when all else is done.
    pub(in crate::trial) fn last(&self, parameters: &Parameters) -> Option<Last> {
        match self.act {
            Act::Last(of) => Some(of(parameters)),
            _ => None,
        }
    }
}

fn parameters<const N: usize>(of: [(&str, f64); N]) -> Parameters {
    of.into_iter().map(|(name, value)| (name.to_string(), value)).collect()
}

/// Three parameters with one unit, such as `x_nT`, in any direction.
fn any_vector(unit: &str, draw: &mut Draw) -> Parameters {
    ["x", "y", "z"].map(|k| (format!("{k}_{unit}"), draw.random_range(-1.0..1.0))).into_iter().collect()
}

fn vector(parameters: &Parameters, unit: &str) -> Vector {
    ["x", "y", "z"].map(|k| parameters[&format!("{k}_{unit}")])
}

fn either_sign(draw: &mut Draw) -> f64 {
    if draw.random_bool(0.5) { 1.0 } else { -1.0 }
}
