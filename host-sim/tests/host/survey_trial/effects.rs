//! Effects of the sensors on tows without iron: none that is named may become a contact. Two presets, each effect alone and
//! none, some seeds; what the survey says it took off, and how many contacts it has. Where an effect is not named nothing is asked.
//!
//! `SURVEY_TRIAL_SEEDS=1..4` is the run for tuning, 701..704 the one that judges; `SURVEY_TRIAL_EFFECTS=lag,step` those whose names
//! hold one of these.

use std::time::Instant;

use host_sim::effects::Request;
use host_sim::simulator::scenario::{Scenario, Simulation};
use rayon::prelude::*;

use super::csv_file::CsvFile;
use super::program::{self, Folder};
use super::score::Contact;
use super::statistics::rate;
use super::table::{FREE, Figure, finish};

const TOWS: [(&str, &str); 2] = [
    ("lake", include_str!("../../../../scenarios/lake_tow.toml")),
    ("sea", include_str!("../../../../scenarios/sea_tow.toml")),
];

/// Several turns, and all that happens once happens well inside, s.
const DURATION_S: f64 = 900.0;

/// Effects as a fault that is worth mending has them; steps and loads strong and weak.
const EFFECTS: [&str; 25] = [
    "",
    "permanent_step:time_s=600,x_nT=3,y_nT=-2,z_nT=2",
    "permanent_step:time_s=500,x_nT=20,y_nT=-20,z_nT=15",
    "load_current:x_nT=2,y_nT=1,z_nT=-2,period_s=20,duty=0.5,phase=0.1",
    "load_current:x_nT=2,y_nT=1,z_nT=-2,period_s=120,duty=0.3,phase=0.1",
    "load_current:x_nT=0.3,y_nT=0.2,z_nT=-0.3,period_s=45,duty=0.1,phase=0.3",
    "load_current:x_nT=10,y_nT=5,z_nT=-8,period_s=300,duty=0.05,phase=0.5",
    "scalar_lag:lag_s=0.15",
    "sample_slip:time_s=600,samples=3",
    "sample_jitter:sigma_s=0.02",
    "stale_sample:probability=0.05",
    "scalar_lowpass:time_constant_s=0.3",
    "clock_drift:rate_ppm=200",
    "eddy_lag:time_constant_s=0.3",
    "second_order:scale=3",
    "heading_error:axis_azimuth_deg=40,axis_elevation_deg=20,cubic_nT=3,quartic_nT=2",
    "dead_zone:axis_azimuth_deg=60,axis_elevation_deg=30,half_angle_deg=40,noise_nT=1",
    "permanent_temperature:x_nT_per_K=2,y_nT_per_K=-1,z_nT_per_K=1",
    "fluxgate_bias:x_nT=100,y_nT=-80,z_nT=50",
    "mains_alias:frequency_hz=0.31,amplitude_nT=1,phase_rad=0.3",
    "fluxgate_quantisation:step_nT=30",
    "fluxgate_nonlinearity:cubic_ppm=300",
    "depth_gradient:gradient_nT_per_m=1",
    "swell_induction:gain_nT_per_m=1",
    "fluxgate_temperature_drift:x_nT_per_K=10,y_nT_per_K=-8,z_nT_per_K=5",
];

/// What one tow gave.
struct Outcome {
    effect: &'static str,
    hours: f64,
    contacts: usize,
    stated_per_hour: f64,
    /// What was taken off.
    named: Vec<String>,
}

impl Outcome {
    /// Whether its own effect was named; nothing has to be where there is none.
    fn is_named(&self) -> bool {
        let name = self.effect.split(':').next().unwrap_or_default();
        name.is_empty() || self.named.iter().any(|named| named == name)
    }
}

fn outcome(folder: &Folder, (effect, tow, seed): (&'static str, usize, u64)) -> Result<Outcome, String> {
    let (name, preset) = TOWS[tow];
    let scenario = Scenario { duration_s: DURATION_S, ..Scenario::parse(preset).unwrap() };
    let simulation = Simulation::new(&scenario, seed)?;
    let requests: Vec<Request> =
        [effect].into_iter().filter(|text| !text.is_empty()).map(|text| text.parse().unwrap()).collect();
    let at = EFFECTS.iter().position(|other| *other == effect).unwrap();
    let recording = folder.file(&format!("{name}_{at}_{seed}.csv"));
    let mut bytes = Vec::new();
    simulation.record(&requests).write_csv(&mut bytes).map_err(|error| error.to_string())?;
    std::fs::write(&recording, bytes).map_err(|error| error.to_string())?;
    let out = recording.with_extension("");
    program::survey(&recording, None, &out)?;
    let summary = program::summary(&out);
    let taken_off = summary["recordings"][0]["effects"].as_array().cloned().unwrap_or_default();
    Ok(Outcome {
        effect,
        hours: summary["duration_s"].as_f64().ok_or("summary.json: no duration_s")? / 3600.0,
        contacts: Contact::all(&CsvFile::read(&out.join("contacts.csv"))).len(),
        stated_per_hour: summary["false_alarms_per_hour"].as_f64().ok_or("no false_alarms_per_hour")?,
        named: taken_off.iter().filter_map(|effect| effect["name"].as_str()).map(String::from).collect(),
    })
}

fn all(seeds: std::ops::Range<u64>) -> Vec<Outcome> {
    let only = std::env::var("SURVEY_TRIAL_EFFECTS").unwrap_or_default();
    let is_meant = |effect: &&&str| only.split(',').any(|part| effect.contains(part));
    let folder = Folder::new("effects");
    let jobs: Vec<(&str, usize, u64)> = EFFECTS
        .iter()
        .filter(is_meant)
        .flat_map(|effect| (0..TOWS.len()).map(move |tow| (*effect, tow)))
        .flat_map(|(effect, tow)| seeds.clone().map(move |seed| (effect, tow, seed)))
        .collect();
    let run = |job: (&'static str, usize, u64)| {
        outcome(&folder, job).map_err(|error| println!("failed: {} {} {}: {error}", job.0, TOWS[job.1].0, job.2)).ok()
    };
    jobs.into_par_iter().filter_map(run).collect()
}

/// Contacts in an hour, and how many of how many tows had their effect named, and what else was named.
fn figure(title: &str, outcomes: &[&Outcome], most: f64) -> Figure {
    let count = outcomes.iter().map(|outcome| outcome.contacts).sum();
    let [value, low, high] = rate(count, outcomes.iter().map(|outcome| outcome.hours).sum());
    let named = outcomes.iter().filter(|outcome| outcome.is_named()).count();
    let own = |outcome: &Outcome| outcome.effect.split(':').next().unwrap_or_default();
    let mut others: Vec<&str> = outcomes
        .iter()
        .flat_map(|outcome| outcome.named.iter().map(String::as_str).filter(|name| *name != own(outcome)))
        .collect();
    others.sort_unstable();
    let others = if others.is_empty() { String::new() } else { format!("; also {}", others.join(", ")) };
    let of = format!("{count}, {low:.2} to {high:.2}; named in {named} of {}{others}", outcomes.len());
    Figure::new(title, [value, FREE[0], most], of)
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn effects() {
    let begin = Instant::now();
    let outcomes = all(program::seeds(701..704));
    assert!(!outcomes.is_empty(), "no effect's name holds what SURVEY_TRIAL_EFFECTS says");
    let mut figures: Vec<Figure> = Vec::new();
    for effect in EFFECTS {
        let of: Vec<&Outcome> = outcomes.iter().filter(|outcome| outcome.effect == effect).collect();
        if !of.is_empty() {
            figures.push(figure(if effect.is_empty() { "none" } else { effect }, &of, FREE[1]));
        }
    }
    let stated = outcomes[0].stated_per_hour;
    let is_an_effect = |outcome: &&Outcome| !outcome.effect.is_empty();
    let (named, unnamed): (Vec<&Outcome>, Vec<&Outcome>) =
        outcomes.iter().filter(is_an_effect).partition(|outcome| outcome.is_named());
    figures.push(figure("Contacts in an hour, effect named", &named, stated));
    figures.push(figure("- effect not named", &unnamed, FREE[1]));
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Effects and contacts", &figures);
}
