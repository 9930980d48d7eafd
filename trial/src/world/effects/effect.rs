//! What one effect of the trial is.

use std::collections::BTreeMap;

use rand::RngExt;

use super::super::vector::Vector;
use super::super::{Change, Last, World};
use crate::random::Random;

/// By name, in the units of the name.
pub(crate) type Parameters = BTreeMap<String, f64>;

/// The sensor whose reading an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channel {
    Scalar,
    Fluxgate,
}

/// What an effect does to a recording.
pub(crate) enum Act {
    /// To the clean scalar, nT at each row.
    Scalar(fn(&World, &Parameters, &mut Random) -> Vec<f64>),
    /// To the clean fluxgate.
    Fluxgate(fn(&World, &Parameters) -> Vec<Vector>),
    /// To the readings when all else is done.
    Last(fn(&Parameters) -> Last),
    /// What a user wrote.
    Own(Box<dyn Written>),
}

/// What a user wrote, by a model of its own.
pub(crate) trait Written: Send + Sync {
    /// What it changes at each row.
    fn change(&self, world: &World, parameters: &Parameters) -> Change;
    /// Any parameters within their bounds; none where this world lacks what it is made of.
    fn drawn(&self, world: &World, draw: &mut Random) -> Option<Parameters>;
    /// How many times as large all sizes may be within their bounds.
    fn room(&self, parameters: &Parameters) -> f64;
}

/// One effect.
pub(crate) struct Effect {
    pub(crate) name: &'static str,
    pub(crate) channel: Channel,
    /// The parameters that make it larger or smaller, and the largest that each may be; none where it has steps.
    pub(crate) sizes: &'static [&'static str],
    pub(crate) most: f64,
    /// Parameters of any size; none where this world has not what the effect acts on.
    pub(crate) draw: fn(&World, &mut Random) -> Option<Parameters>,
    pub(crate) act: Act,
}

impl Effect {
    /// What it adds to the clean readings.
    pub(crate) fn change(&self, world: &World, parameters: &Parameters, draw: &mut Random) -> Change {
        match &self.act {
            Act::Scalar(of) => Change { scalar_nt: of(world, parameters, draw), ..Change::default() },
            Act::Fluxgate(of) => Change { flux_nt: of(world, parameters), ..Change::default() },
            Act::Last(_) => Change::default(),
            Act::Own(written) => written.change(world, parameters),
        }
    }

    /// Parameters of any size; none where this world has not what the effect acts on.
    pub(crate) fn drawn(&self, world: &World, draw: &mut Random) -> Option<Parameters> {
        match &self.act {
            Act::Own(written) => written.drawn(world, draw),
            _ => (self.draw)(world, draw),
        }
    }

    /// How many times as large its sizes may be.
    pub(crate) fn room(&self, parameters: &Parameters) -> f64 {
        match &self.act {
            Act::Own(written) => written.room(parameters),
            _ => self.most / self.sizes.iter().map(|name| parameters[*name].abs()).fold(0.0, f64::max),
        }
    }

    /// What it does when all else is done.
    pub(crate) fn last(&self, parameters: &Parameters) -> Option<Last> {
        match &self.act {
            Act::Last(of) => Some(of(parameters)),
            _ => None,
        }
    }
}

pub(super) fn parameters<const N: usize>(of: [(&str, f64); N]) -> Parameters {
    of.into_iter().map(|(name, value)| (name.to_string(), value)).collect()
}

/// Three parameters with one unit, such as `x_nT`, in any direction.
pub(super) fn any_vector(unit: &str, draw: &mut Random) -> Parameters {
    ["x", "y", "z"].map(|k| (format!("{k}_{unit}"), draw.random_range(-1.0..1.0))).into_iter().collect()
}

pub(super) fn vector(parameters: &Parameters, unit: &str) -> Vector {
    ["x", "y", "z"].map(|k| parameters[&format!("{k}_{unit}")])
}

pub(super) fn either_sign(draw: &mut Random) -> f64 {
    if draw.random_bool(0.5) { 1.0 } else { -1.0 }
}
