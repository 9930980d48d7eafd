//! What was found of the effects that were put into a real recording.

use serde::Serialize;

use super::judged::{Judged, level, stands_for};
use super::rate::Rate;
use super::targets::is_near;
use crate::answer::{Answer, Target};
use crate::reply::TrialResult;
use crate::said::{Said, SaidEffect};
use crate::strength::STRENGTHS;

/// What was found of the effects that were put in.
#[derive(Clone, Debug, Serialize)]
pub struct OnScore {
    /// What the diagnosis says of the untouched recording, in a sentence.
    pub untouched: String,
    /// The effects that it names there.
    pub untouched_effects: Vec<String>,
    /// Rms that a hindsight fit of the 18 terms leaves of the scalar, nT: the strengths are relative to it.
    #[serde(rename = "scalar_residual_rms_nT")]
    pub scalar_residual_rms_nt: f64,
    /// And of the fluxgate's magnitude less the field that the scalar then gives, nT.
    #[serde(rename = "fluxgate_residual_rms_nT")]
    pub fluxgate_residual_rms_nt: f64,
    /// By strength: newly named, or with parameters that moved.
    pub named: Vec<OnBin>,
    /// The same of strength 3 and 10 together.
    pub named_from_3: Rate,
    /// Recordings with another effect newly named that is neither put in nor alike.
    pub others_named: Rate,
    /// Targets that were put in and are listed, without those where the untouched recording has one.
    pub targets_listed: Rate,
    /// Effects of strength 3 and 10 that were not.
    pub missed: Vec<String>,
}

/// Effects of about one strength.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OnBin {
    /// Effect rms over the recording's own residual, about.
    pub strength: f64,
    /// Newly named, or in the stated set of one that is.
    pub named: Rate,
}

/// `residual_rms_nt` is what strengths are relative to, of the scalar and of the fluxgate.
pub(crate) fn on_score(
    residual_rms_nt: [f64; 2],
    answers: &[Answer],
    untouched: &Said,
    results: &[TrialResult],
) -> OnScore {
    let all: Vec<Judged<'_>> = answers.iter().zip(results).collect();
    let is_named = |(answer, result): &Judged<'_>| {
        let effects = &result.diagnosis.said().effects;
        effects.iter().any(|effect| stands_for(effect, &answer.hidden[0]) && is_new(effect, untouched))
    };
    let at = |wanted: &dyn Fn(f64) -> bool| -> Vec<Judged<'_>> {
        all.iter().copied().filter(|judged| wanted(level(judged))).collect()
    };
    let strong = at(&|strength| strength >= STRENGTHS[1]);
    let bin = |strength| OnBin { strength, named: Rate::count(&at(&|other| other == strength), is_named) };
    OnScore {
        untouched: untouched.summary.clone(),
        untouched_effects: untouched.effects.iter().map(|effect| effect.name.clone()).collect(),
        scalar_residual_rms_nt: residual_rms_nt[0],
        fluxgate_residual_rms_nt: residual_rms_nt[1],
        named: STRENGTHS.map(bin).into(),
        named_from_3: Rate::count(&strong, is_named),
        others_named: Rate::count(&all, |(answer, result)| {
            let is_other = |effect: &&SaidEffect| !stands_for(effect, &answer.hidden[0]);
            result.diagnosis.said().effects.iter().filter(is_other).any(|effect| is_new(effect, untouched))
        }),
        targets_listed: targets_listed(&all, untouched),
        missed: strong.iter().filter(|judged| !is_named(judged)).map(described).collect(),
    }
}

fn targets_listed(all: &[Judged<'_>], untouched: &Said) -> Rate {
    let own = |(answer, result): &Judged<'_>| -> Vec<bool> {
        let listed = |said: &Said, truth: &Target| said.targets.iter().any(|target| is_near(target, truth));
        let new = answer.targets.iter().filter(|truth| !listed(untouched, truth));
        new.map(|truth| listed(result.diagnosis.said(), truth)).collect()
    };
    let each: Vec<bool> = all.iter().flat_map(own).collect();
    Rate::count(&each, |is_listed| *is_listed)
}

/// "scalar_lag at 3.1: averaging_window".
fn described((answer, result): &Judged<'_>) -> String {
    let names: Vec<&str> = result.diagnosis.said().effects.iter().map(|effect| effect.name.as_str()).collect();
    let hidden = &answer.hidden[0];
    format!(
        "{} at {:.1}: {}",
        hidden.name,
        hidden.strength,
        if names.is_empty() { "-".into() } else { names.join(" + ") }
    )
}

/// Whether the untouched recording does not show an effect, or not with these parameters.
fn is_new(effect: &SaidEffect, untouched: &Said) -> bool {
    let Some(before) = untouched.effects.iter().find(|other| other.name == effect.name) else { return true };
    effect.parameters.iter().zip(&before.parameters).any(|(now, before)| {
        let (Some(a), Some(b), Some(x), Some(y)) = (now.value, before.value, now.ci95, before.ci95) else {
            return false;
        };
        (a - b).abs() > (0.5 * (x[1] - x[0])).hypot(0.5 * (y[1] - y[0]))
    })
}
