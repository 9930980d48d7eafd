//! What is told of a planned tow.

use crate::diagnosis::manoeuvre::kind::ManoeuvreKind;
use crate::effects::Spec;

/// Strength at which effects are told apart by the segments that are proposed: the rms of what an effect adds, over that of the noise.
pub const PLANNED_STRENGTH: f64 = 3.0;

/// What a planned tow can tell.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Length of the planned recording, minutes.
    pub minutes: f64,
    /// Noise of the scalar, nT rms.
    pub noise_nt: Option<f64>,
    /// Every effect that has a meaning there and is not random from row to row, in the order of the library.
    pub effects: Vec<PlannedEffect>,
    /// What to sail beside it, the one that tells most pairs apart first.
    pub segments: Vec<Segment>,
    /// The effects that were planned for, for what is written about them.
    pub specs: Vec<&'static Spec>,
}

/// What a planned tow can tell of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedEffect {
    /// Its name.
    pub name: &'static str,
    /// Which channel it is in.
    pub channel: &'static str,
    /// Its parameters where it is as strong as the noise, by name.
    pub at_strength_1: Vec<(&'static str, f64)>,
    /// Strength from which a diagnosis finds it; `None` where it does not up to 1000.
    pub found_from: Option<f64>,
    /// What it could be taken for although it is found, the one that is worst told apart first.
    pub alike: Vec<Alike>,
}

/// An effect that another one looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike {
    /// Its name.
    pub name: &'static str,
    /// Strength of the other one from which the two are told apart; `None` where they are not up to 1000.
    pub apart_from: Option<f64>,
}

/// What to sail beside the planned tow.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Which manoeuvre.
    pub kind: ManoeuvreKind,
    /// For how long, minutes.
    pub minutes: f64,
    /// What it tells apart.
    pub separates: Vec<Separated>,
}

/// Two effects that a segment tells apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separated {
    /// The one, and what it may be taken for.
    pub names: [&'static str; 2],
    /// Strength from which they are told apart, both recordings together.
    pub apart_from: f64,
}

/// A strength to compare by.
pub(super) fn strength(of: Option<f64>) -> f64 {
    of.unwrap_or(f64::INFINITY)
}
