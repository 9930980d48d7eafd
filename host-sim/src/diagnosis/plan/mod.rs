//! Before the tow: what a planned manoeuvre would show of each effect, which effects it could not tell apart at which strength, and
//! what to sail beside it so that they come apart.
//!
//! The planned recording is simulated once with noise, which gives noise model and weights as a diagnosis would have them. Each effect
//! is then put into it without noise: what is left of it beside 18 terms and background, and beside the best that another effect can do,
//! is the evidence that a diagnosis would have on average (as [`super::manoeuvre`]'s, T-criterion, Atkinson and Fedorov 1975).

mod planned;
mod segments;
mod told;

use rayon::prelude::*;

pub use self::told::{Alike, PLANNED_STRENGTH, Plan, PlannedEffect, Segment, Separated};
use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::Findings;
use crate::diagnosis::noise::model::NoiseModel;
use planned::Sown;
use told::strength;

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
