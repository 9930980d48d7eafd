//! Effects put into a real recording: those that need no other physics than what was recorded.

use std::fmt::Write;

use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;

use super::answer::{Answer, Kind};
use super::draw::STRENGTHS;
use super::identifiable::{beside, term_columns, unit};
use super::score::{Rate, stands_for};
use super::size::sized;
use super::slow::{rms, without};
use super::world::effects::{self, Effect};
use super::world::recorded::with_readings;
use super::world::{Draw, Noise, World, magnitudes};
use super::{Said, Sealed, TrialOptions, bar, open, slim};
use crate::diagnosis::{DiagnoseSettings, Diagnosis, EffectFound, Table, diagnose};
use crate::error::HostError;

/// The effects that can be.
const EFFECTS: [&str; 17] = [
    "scalar_lag",
    "clock_drift",
    "sample_slip",
    "sample_jitter",
    "stale_sample",
    "averaging_window",
    "scalar_lowpass",
    "mains_alias",
    "fluxgate_bias",
    "fluxgate_scale",
    "fluxgate_nonorthogonality",
    "fluxgate_nonlinearity",
    "fluxgate_quantisation",
    "permanent_step",
    "load_current",
    "heading_error",
    "dead_zone",
];
/// Parameters until an effect reaches its strength.
const TRIES: usize = 6;
/// How far beyond what is plausible a parameter may go: a real recording is louder than noise.
const STRETCH: f64 = 3.0;

/// What was found of the effects that were put in.
#[derive(Clone, Debug, Serialize)]
pub struct OnScore {
    /// What the diagnosis says of the untouched recording, in a sentence.
    pub untouched: String,
    /// The effects that it names there.
    pub untouched_effects: Vec<&'static str>,
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

/// Draw what is put in. Each effect comes with each strength before any comes twice.
pub(super) fn draw(options: &TrialOptions, table: &Table) -> Sealed {
    let world = world(table);
    let one = |index: usize| answer(options, &world, index);
    let answers: Vec<Answer> = (0..options.recordings).into_par_iter().filter_map(one).collect();
    Sealed::of(&answers)
}

/// The recording with what an answer puts in.
pub(super) fn injected(options: &TrialOptions, table: &Table, answer: &Answer) -> Table {
    let world = world(table);
    let mut changes = Vec::new();
    let mut last = Vec::new();
    for hidden in &answer.hidden {
        let draw = || stream(options, answer.index, 1);
        let Some(effect) = effects::named(&hidden.name) else { continue };
        changes.push(effect.change(&world, &hidden.parameters, &mut draw()));
        last.extend(effect.last(&hidden.parameters).map(|last| (last, draw())));
    }
    with_readings(table, &world.record(&changes, last, &mut stream(options, answer.index, 2)))
}

/// What of a recording a diagnosis of its sensors needs, as a file.
pub(super) fn csv(table: &Table) -> String {
    let mut text = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,scalar_valid\n".to_string();
    for row in 0..table.len() {
        let ([x, y, z], scalar_nt, time_s) = (table.flux_nt[row], table.scalar_nt[row], table.time_s[row]);
        _ = match table.usable[row] {
            true => writeln!(text, "{time_s},{scalar_nt:.4},{x:.4},{y:.4},{z:.4},1"),
            false => writeln!(text, "{time_s},,,,,0"),
        };
    }
    text
}

/// Diagnose the untouched recording, then every injected one.
pub(super) fn diagnose_all(
    options: &TrialOptions,
    table: &Table,
    sealed: &Sealed,
) -> Result<(Diagnosis, Vec<Said>), HostError> {
    let answers = open(sealed)?;
    let settings = DiagnoseSettings {
        withheld: options.withhold.iter().cloned().collect(),
        seed: options.seed,
        coefficients: None,
        ..DiagnoseSettings::default()
    };
    let untouched = slim(diagnose(table, None, &settings)?);
    let all = bar(answers.len(), "diagnosing");
    let one = |answer: &Answer| {
        let diagnosis = slim(diagnose(&injected(options, table, answer), None, &settings)?);
        all.inc(1);
        Ok(Said { diagnosis, put_back: None })
    };
    let said = answers.par_iter().map(one).collect::<Result<Vec<Said>, HostError>>()?;
    all.finish_and_clear();
    Ok((untouched, said))
}

pub(super) fn score(
    table: &Table,
    sealed: &Sealed,
    untouched: &Diagnosis,
    said: &[Said],
) -> Result<OnScore, HostError> {
    let answers = open(sealed)?;
    let world = world(table);
    let is_named = |(answer, said): &(&Answer, &Said)| {
        let name = &answer.hidden[0].name;
        said.diagnosis.effects.iter().any(|effect| stands_for(effect, name) && is_new(effect, untouched))
    };
    let near = |strength: f64| STRENGTHS.into_iter().min_by(|a, b| far(*a, strength).total_cmp(&far(*b, strength)));
    let at = |wanted: &dyn Fn(f64) -> bool| -> Vec<(&Answer, &Said)> {
        answers.iter().zip(said).filter(|(answer, _)| near(answer.hidden[0].strength).is_some_and(wanted)).collect()
    };
    let strong = at(&|strength| strength >= STRENGTHS[1]);
    Ok(OnScore {
        untouched: untouched.summary.clone(),
        untouched_effects: untouched.effects.iter().map(|effect| effect.name).collect(),
        scalar_residual_rms_nt: world.noise.band_rms_nt(),
        fluxgate_residual_rms_nt: world.flux_noise_nt,
        named: STRENGTHS
            .iter()
            .map(|&strength| OnBin { strength, named: Rate::count(&at(&|other| other == strength), is_named) })
            .collect(),
        named_from_3: Rate::count(&strong, is_named),
        missed: strong.iter().filter(|pair| !is_named(pair)).map(described).collect(),
    })
}

/// "scalar_lag at 3.1: averaging_window".
fn described((answer, said): &(&Answer, &Said)) -> String {
    let names: Vec<&str> = said.diagnosis.effects.iter().map(|effect| effect.name).collect();
    let hidden = &answer.hidden[0];
    format!(
        "{} at {:.1}: {}",
        hidden.name,
        hidden.strength,
        if names.is_empty() { "-".into() } else { names.join(" + ") }
    )
}

/// Whether the untouched recording does not show an effect, or not with these parameters.
fn is_new(effect: &EffectFound, untouched: &Diagnosis) -> bool {
    let Some(before) = untouched.effects.iter().find(|other| other.name == effect.name) else { return true };
    effect.parameters.iter().zip(&before.parameters).any(|(now, before)| {
        let (Some(a), Some(b), Some(x), Some(y)) = (now.value, before.value, now.ci95, before.ci95) else {
            return false;
        };
        (a - b).abs() > (0.5 * (x[1] - x[0])).hypot(0.5 * (y[1] - y[0]))
    })
}

fn far(a: f64, b: f64) -> f64 {
    (a / b).ln().abs()
}

fn answer(options: &TrialOptions, world: &World, index: usize) -> Option<Answer> {
    let name = EFFECTS[index % EFFECTS.len()];
    let effect: &Effect = effects::named(name)?;
    let most = (index / EFFECTS.len() + index) % STRENGTHS.len();
    let mut draw = stream(options, index, 0);
    // On a loud recording some effects do not reach every strength: then the next lower one.
    let hidden = STRENGTHS[..=most].iter().rev().find_map(|aim| {
        (0..TRIES).find_map(|_| {
            let aim = aim * draw.random_range(0.8..1.2);
            sized(world, effect, (effect.draw)(world, &mut draw)?, aim, STRETCH, || stream(options, index, 1))
        })
    })?;
    Some(Answer {
        index,
        kind: Kind::Single,
        motion: world.motion().into(),
        noise: "recorded".into(),
        noise_rms_nt: world.noise.band_rms_nt(),
        fluxgate_noise_rms_nt: world.flux_noise_nt,
        world: 0,
        hidden: vec![hidden],
    })
}

fn stream(options: &TrialOptions, index: usize, purpose: u64) -> Draw {
    let mut draw = Draw::seed_from_u64(options.seed);
    draw.set_stream(((index as u64) << 8) | purpose);
    draw
}

/// The recording, with what the 18 terms leave of it as its noise.
fn world(table: &Table) -> World {
    let mut world = World::of_recording(table);
    let clean = world.clean();
    let columns: Vec<Vec<f64>> = term_columns(&world).into_iter().map(unit).collect();
    let rest = beside(&without(&clean.scalar_nt), &columns);
    let magnitude = without(&magnitudes(&clean.flux_nt));
    world.noise = Noise::white(rms(&rest));
    // What the scalar takes for the field, less the background, is that rest.
    world.flux_noise_nt = rms(&magnitude.iter().zip(&rest).map(|(f, s)| f - s).collect::<Vec<f64>>());
    world
}
