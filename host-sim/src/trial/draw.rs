//! What a recording of a trial hides, and the recording itself.

use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};

use super::{TrialOptions, foreign};
use crate::error::HostError;
use crate::simulator::effect::{Channel, Draw, Readings, Spec};
use crate::simulator::library::{Request, library};
use crate::simulator::scenario::{Colour, Motion, Scenario, Simulation};

/// What is hidden in a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing.
    None,
    /// One effect of the library.
    Single,
    /// Two.
    Pair,
    /// A mechanism that the library does not have.
    Foreign,
}

/// The answer to one recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Number of the recording, from 0.
    pub index: usize,
    /// What is hidden.
    pub kind: Kind,
    /// The scenario that it was drawn from.
    pub motion: String,
    /// Colour of the scalar's noise.
    pub noise: String,
    /// The effects or the mechanism.
    pub hidden: Vec<Hidden>,
}

/// One effect or mechanism.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Its name.
    pub name: String,
    /// Of a mechanism: its size, nT. Of an effect: its parameters, in the order of the library.
    pub parameters: Vec<f64>,
    /// Its rms over that of the noise, both without what is slower than about 0.04 Hz.
    pub strength: f64,
}

const MOTIONS: [(&str, &str); 3] = [
    ("land_calibration", include_str!("../../../scenarios/land_calibration.toml")),
    ("lake_tow", include_str!("../../../scenarios/lake_tow.toml")),
    ("sea_tow", include_str!("../../../scenarios/sea_tow.toml")),
];
/// Legs in a recording of a tow.
const LEGS: f64 = 4.0;
/// Strengths that are drawn, log-uniform.
const STRENGTHS: [f64; 2] = [0.5, 10.0];
/// Draws of an effect until one has the strength within what is plausible.
const ATTEMPTS: usize = 60;
/// How far beyond the plausible range a parameter may go to reach its strength.
const STRETCH: f64 = 2.0;
/// Rows of the mean that is taken off before an rms: half of the power is gone at 0.04 Hz.
const SLOW_ROWS: usize = 111;

/// Draw the answer to a recording.
pub(super) fn answer(options: &TrialOptions, index: usize) -> Result<Answer, HostError> {
    let mut draw = stream(options, index, 0);
    let (simulation, motion, noise) = played(options, index)?;
    let kind = match draw.random::<f64>() {
        p if p < 0.30 => Kind::None,
        p if p < 0.75 => Kind::Single,
        p if p < 0.90 => Kind::Pair,
        _ => Kind::Foreign,
    };
    let mut hidden: Vec<Hidden> = Vec::new();
    match kind {
        Kind::None => {}
        Kind::Single => hidden.extend(effect(&simulation, options.withhold.as_deref(), None, &mut draw)),
        Kind::Pair => {
            for _ in 0..2 {
                let other = hidden.first().map(|hidden| hidden.name.clone());
                hidden.extend(effect(&simulation, None, other.as_deref(), &mut draw));
            }
        }
        Kind::Foreign => hidden.push(mechanism(options, index, &simulation, &mut draw)),
    }
    // What cannot reach its strength here is not hidden.
    let kind = match (kind, hidden.len()) {
        (_, 0) => Kind::None,
        (Kind::Pair, 1) => Kind::Single,
        (kind, _) => kind,
    };
    Ok(Answer { index, kind, motion, noise, hidden })
}

/// The recording of an answer, as CSV.
pub(super) fn recording(options: &TrialOptions, answer: &Answer) -> Result<Vec<u8>, HostError> {
    let (simulation, ..) = played(options, answer.index)?;
    let mut recorded = simulation.record(&requests(answer));
    if answer.kind == Kind::Foreign {
        for hidden in &answer.hidden {
            let unit = foreign::change_nt(&hidden.name, simulation.signals(), &mut stream(options, answer.index, 2));
            recorded.readings.scalar_nt.iter_mut().zip(unit).for_each(|(nt, unit)| *nt += hidden.parameters[0] * unit);
        }
    }
    let mut csv = Vec::new();
    recorded.write_csv(&mut csv)?;
    Ok(csv)
}

fn requests(answer: &Answer) -> Vec<Request> {
    let of = |hidden: &Hidden| {
        let effect = library().into_iter().find(|effect| effect.spec().name == hidden.name)?;
        Some(Request { effect, parameters: hidden.parameters.clone() })
    };
    answer.hidden.iter().filter_map(of).collect()
}

fn stream(options: &TrialOptions, index: usize, offset: u64) -> Draw {
    let mut draw = Draw::seed_from_u64(options.seed);
    draw.set_stream(3 * index as u64 + offset);
    draw
}

/// A scenario with place, noise and coefficients drawn anew, played; what motion and noise it has.
fn played(options: &TrialOptions, index: usize) -> Result<(Simulation, String, String), HostError> {
    let mut draw = stream(options, index, 1);
    let (motion, text) = MOTIONS[draw.random_range(0..MOTIONS.len())];
    let wrong = |what: String| HostError::Usage(format!("a scenario of the trial: {what}"));
    let mut scenario = Scenario::parse(text).map_err(wrong)?;
    scenario.duration_s = 60.0 * options.minutes;
    scenario.field.latitude_deg = Some(draw.random_range(-65.0..65.0));
    scenario.field.longitude_deg = Some(draw.random_range(-180.0..180.0));
    scenario.field.strength_nt = None;
    scenario.interference.uncompensated_std_nt = Some(log_uniform([3.0, 60.0], &mut draw));
    scenario.scalar.noise_rms_nt = log_uniform([0.02, 0.1], &mut draw);
    let (colour, noise) =
        [(Colour::White, "white"), (Colour::Pink, "pink"), (Colour::Ar1, "ar1")][draw.random_range(0..3_usize)];
    scenario.scalar.noise_colour = colour;
    scenario.scalar.noise_correlation = if colour == Colour::Ar1 { draw.random_range(0.3..0.9) } else { 0.0 };
    if let Motion::LakeTow { tow, .. } | Motion::SeaTow { tow, .. } = &mut scenario.motion {
        tow.first_heading_deg = draw.random_range(0.0..360.0);
        tow.turn_deg = 90.0;
        tow.turn_s = 30.0;
        tow.leg_s = (scenario.duration_s / LEGS - tow.turn_s).max(15.0);
    }
    let simulation = Simulation::new(&scenario, draw.random::<u32>().into()).map_err(wrong)?;
    Ok((simulation, motion.into(), noise.into()))
}

fn log_uniform([low, high]: [f64; 2], draw: &mut Draw) -> f64 {
    low * libm::pow(high / low, draw.random::<f64>())
}

/// An effect with a strength that is log-uniform; `name` asks for one, `not` excludes one.
fn effect(simulation: &Simulation, name: Option<&str>, not: Option<&str>, draw: &mut Draw) -> Option<Hidden> {
    let target = log_uniform(STRENGTHS, draw);
    for _ in 0..ATTEMPTS {
        let all: Vec<_> = library()
            .into_iter()
            .filter(|effect| effect.applies_to(simulation.signals()))
            .filter(|effect| name.is_none_or(|name| effect.spec().name == name) && not != Some(effect.spec().name))
            .collect();
        if all.is_empty() {
            return None;
        }
        let at = draw.random_range(0..all.len());
        let effect = all.into_iter().nth(at)?;
        let parameters = parameters(effect.spec(), simulation.signals().epochs_s().last().copied()?, draw);
        if let Some(hidden) = scaled(simulation, Request { effect, parameters }, target) {
            return Some(hidden);
        }
    }
    None
}

/// Parameters anywhere within what is plausible.
fn parameters(spec: &Spec, duration_s: f64, draw: &mut Draw) -> Vec<f64> {
    let draw_one = |parameter: &crate::simulator::effect::Parameter| match parameter.name {
        "time_s" => (10.0 * duration_s * draw.random_range(0.2..0.8)).round() / 10.0,
        "period_s" => log_uniform([2.0, duration_s / 4.0], draw),
        "duty" => draw.random_range(0.1..0.9),
        "frequency_hz" => draw.random_range(0.15..4.5),
        "samples" => f64::from(draw.random_range(1..=5_i32)) * if draw.random_bool(0.5) { 1.0 } else { -1.0 },
        _ => draw.random_range(parameter.plausible[0]..=parameter.plausible[1]),
    };
    spec.parameters.iter().map(draw_one).collect()
}

/// The parameters that make an effect larger or smaller: the linear ones, or the one that is its size.
fn sizes(spec: &Spec) -> Vec<usize> {
    use crate::simulator::effect::{Kind, linear_parameters};
    let named = |name: &str| spec.parameters.iter().position(|parameter| parameter.name == name);
    let linear = linear_parameters(spec);
    match named("noise_nT").or(named("amplitude_nT")) {
        Some(index) => vec![index],
        None if !linear.is_empty() => linear,
        None if spec.parameters.iter().any(|parameter| parameter.kind == Kind::Whole) => Vec::new(),
        None => vec![0],
    }
}

/// The effect scaled to a strength; `None` where that takes it beyond what is plausible.
fn scaled(simulation: &Simulation, mut request: Request, target: f64) -> Option<Hidden> {
    let spec = request.effect.spec();
    let sizes = sizes(spec);
    let mut strength = strength_of(simulation, std::slice::from_ref(&request), spec.channel);
    for _ in 0..8 {
        if sizes.is_empty() || strength <= 0.0 || libm::log(strength / target).abs() < 0.02 {
            break;
        }
        let power = if spec.name == "stale_sample" { 2.0 } else { 1.0 };
        let by = libm::pow(target / strength, power).clamp(0.02, 50.0);
        for &index in &sizes {
            let parameter = &spec.parameters[index];
            let limits = parameter.plausible.map(|end| STRETCH * end);
            let [low, high] = [parameter.range[0].max(limits[0].min(0.0)), parameter.range[1].min(limits[1])];
            request.parameters[index] = (by * request.parameters[index]).clamp(low, high);
        }
        strength = strength_of(simulation, std::slice::from_ref(&request), spec.channel);
    }
    let is_reached = if sizes.is_empty() {
        (STRENGTHS[0]..STRENGTHS[1]).contains(&strength)
    } else {
        libm::log(strength / target).abs() < 0.1
    };
    is_reached.then(|| Hidden { name: spec.name.into(), parameters: request.parameters, strength })
}

fn mechanism(options: &TrialOptions, index: usize, simulation: &Simulation, draw: &mut Draw) -> Hidden {
    let name = foreign::NAMES[draw.random_range(0..foreign::NAMES.len())];
    let strength = log_uniform(STRENGTHS, draw);
    let unit = foreign::change_nt(name, simulation.signals(), &mut stream(options, index, 2));
    let noise_nt = noise_rms_nt(simulation, Channel::Scalar);
    let size_nt = strength * noise_nt / rms(&fast(&unit)).max(1e-9);
    Hidden { name: name.into(), parameters: vec![size_nt], strength }
}

fn strength_of(simulation: &Simulation, requests: &[Request], channel: Channel) -> f64 {
    let (with, without) = (simulation.record(requests).readings, simulation.record(&[]).readings);
    rms(&fast(&less(&with, &without, channel))) / noise_rms_nt(simulation, channel)
}

fn noise_rms_nt(simulation: &Simulation, channel: Channel) -> f64 {
    let rows = simulation.signals().rows();
    let clean = Readings { scalar_nt: rows.scalar_nt.clone(), flux_nt: rows.flux_nt.clone() };
    rms(&fast(&less(&simulation.record(&[]).readings, &clean, channel)))
}

/// Scalar or fluxgate magnitude of the one less that of the other, nT.
fn less(a: &Readings, b: &Readings, channel: Channel) -> Vec<f64> {
    let magnitude = |f: &[f64; 3]| (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt();
    match channel {
        Channel::Scalar => a.scalar_nt.iter().zip(&b.scalar_nt).map(|(a, b)| a - b).collect(),
        Channel::Fluxgate => a.flux_nt.iter().zip(&b.flux_nt).map(|(a, b)| magnitude(a) - magnitude(b)).collect(),
    }
}

/// Values less their running mean.
fn fast(values: &[f64]) -> Vec<f64> {
    let half = SLOW_ROWS / 2;
    let mut sums = vec![0.0];
    values.iter().for_each(|value| sums.push(sums[sums.len() - 1] + value));
    let mean = |row: usize| {
        let (from, to) = (row.saturating_sub(half), (row + half + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    values.iter().enumerate().map(|(row, value)| value - mean(row)).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
