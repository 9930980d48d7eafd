//! Before the tow: what a planned manoeuvre would show of each effect, which effects it could not tell apart at which strength, and
//! what to sail beside it so that they come apart.
//!
//! The planned recording is simulated once with noise, which gives noise model and weights as a diagnosis would have them. Each effect
//! is then put into it without noise: what is left of it beside 18 terms and background, and beside the best that another effect can do,
//! is the evidence that a diagnosis would have on average (as [`super::manoeuvre`]'s, T-criterion, Atkinson and Fedorov 1975). It grows
//! with the square of the strength.

mod planned;
mod segments;

use rayon::prelude::*;

use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::Findings;
use crate::diagnosis::manoeuvre::kind::ManoeuvreKind;
use crate::diagnosis::noise::model::NoiseModel;
use crate::effects::Spec;
use planned::Sown;

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

/// What is planned, from the findings in a simulated recording of it of which nothing may be named.
pub(super) fn of(found: &Findings<'_>) -> Plan {
    let sown: Vec<Sown<'_>> = found
        .channels()
        .into_iter()
        .flat_map(|channel| {
            let selection = &channel.selection;
            (0..found.library.len()).filter_map(|effect| Sown::of(selection, effect)).collect::<Vec<_>>()
        })
        .collect();
    let effects: Vec<PlannedEffect> = sown.par_iter().map(planned_effect).collect();
    Plan {
        minutes: found.scalar.selection.problem.duration_s() / 60.0,
        noise_nt: NoiseModel::std_nt(&found.scalar.selection.noise),
        segments: segments::of(&sown, &effects),
        specs: found.specs.clone(),
        effects,
    }
}

fn planned_effect(sown: &Sown<'_>) -> PlannedEffect {
    let found_from = sown.found_from();
    let mut alike: Vec<Alike> = sown
        .others()
        .map(|other| Alike { name: sown.name_of(other), apart_from: sown.apart_from(other) })
        .filter(|alike| strength(alike.apart_from) > strength(found_from))
        .collect();
    alike.sort_by(|a, b| strength(b.apart_from).total_cmp(&strength(a.apart_from)));
    PlannedEffect {
        name: sown.name_of(sown.effect()),
        channel: channel_name(sown.channel()),
        at_strength_1: sown.at_strength_1(),
        found_from,
        alike,
    }
}

/// A strength to compare by.
fn strength(of: Option<f64>) -> f64 {
    of.unwrap_or(f64::INFINITY)
}
