//! Contacts of drawn tows: found, false, where, how far, how strong. No calibration is given.
//!
//! `SURVEY_TRIAL_SEEDS=1..41` is the run for tuning, 701..1101 the one that judges. What is missed at a signal to noise of
//! 15 and more, and every false contact, is listed with its seed; with `SURVEY_TRIAL_KEEP` the recordings stay.

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use host_sim::simulator::scenario::Simulation;
use rayon::prelude::*;
use serde_json::Value;

use super::csv_file::CsvFile;
use super::draw::{Drawn, Knows, tow};
use super::program::{self, Folder};
use super::score::{Contact, FOUND_FROM, MEASURED_FROM, Matched, holds, matched};
use super::statistics::{mean, quantile, rate, share};
use super::table::{FREE, Figure, finish};
use super::truth::{Iron, iron};

/// What one tow gave.
pub(super) struct Outcome {
    pub(super) seed: u64,
    pub(super) motion: &'static str,
    pub(super) speed_m_per_s: f64,
    knows: Knows,
    hours: f64,
    stated_per_hour: f64,
    pub(super) iron: Vec<Iron>,
    pub(super) matched: Matched,
    /// For each dipole how far its contact is off, m, ahead and to starboard, where a place was given.
    pub(super) off_m: Vec<Option<[f64; 2]>>,
}

/// The recording of a tow, as its receiver gives the positions.
pub(super) fn record(simulation: &Simulation, drawn: &Drawn, seed: u64, path: &Path) -> Result<(), String> {
    let mut bytes = Vec::new();
    simulation.record(&[]).write_csv(&mut bytes).map_err(|error| error.to_string())?;
    if let Some(receiver) = drawn.receiver {
        bytes = receiver.seen(&bytes, seed).map_err(|error| error.to_string())?;
    }
    std::fs::write(path, bytes).map_err(|error| error.to_string())
}

fn outcome(folder: &Folder, seed: u64, drawn: &Drawn) -> Result<Outcome, String> {
    let simulation = Simulation::new(&drawn.scenario, seed)?;
    let (recording, out) = (folder.file(&format!("{seed}.csv")), folder.file(&seed.to_string()));
    record(&simulation, drawn, seed, &recording)?;
    let iron = iron(&simulation);
    write_truth(&simulation, &iron, &folder.file(&format!("{seed}_truth.csv")));
    let options: &[&str] = if drawn.knows == Knows::Ship { &["--ship-position"] } else { &[] };
    program::survey_with(&recording, options, &out)?;
    let contacts = Contact::all(&CsvFile::read(&out.join("contacts.csv")));
    let speed_m_per_s = drawn.scenario.motion.speed_m_per_s().unwrap();
    let matched = matched(&iron, &contacts, speed_m_per_s);
    let off_m = iron.iter().zip(&matched.of).map(|(iron, of)| off_m(&simulation, iron, of)).collect();
    let stated = program::summary(&out)["false_alarms_per_hour"].clone();
    Ok(Outcome {
        seed,
        motion: drawn.motion,
        speed_m_per_s,
        knows: drawn.knows,
        hours: drawn.scenario.duration_s / 3600.0,
        stated_per_hour: Value::as_f64(&stated).ok_or("summary.json: no false_alarms_per_hour")?,
        iron,
        matched,
        off_m,
    })
}

/// For whoever looks at what was missed.
fn write_truth(simulation: &Simulation, iron: &[Iron], path: &Path) {
    let mut table = String::from("dipole,time_s,distance_m,snr,moment_Am2,latitude_deg,longitude_deg,depth_m\n");
    for (number, iron) in iron.iter().enumerate() {
        let [north_m, east_m, depth_m] = iron.dipole.place_m;
        let [latitude_deg, longitude_deg] = simulation.track().degrees([north_m, east_m]).unwrap();
        let place = format!("{:.3},{latitude_deg:.8},{longitude_deg:.8},{depth_m:.2}", iron.moment_am2());
        for (pass, snr) in &iron.passes {
            table += &format!("{},{:.2},{:.2},{snr:.1},{place}\n", number + 1, pass.time_s, pass.distance_m);
        }
    }
    std::fs::write(path, table).unwrap();
}

/// The contact of a dipole that tells most, and its pass.
pub(super) fn best<T: Copy>(of: &[(T, Contact)]) -> Option<(T, Contact)> {
    of.iter().copied().max_by(|(_, a), (_, b)| a.snr.total_cmp(&b.snr))
}

fn off_m(simulation: &Simulation, iron: &Iron, of: &[(super::truth::Pass, Contact)]) -> Option<[f64; 2]> {
    let (pass, contact) = best(of)?;
    let place_m = simulation.track().metres(contact.place_deg)?;
    let (sin, cos) = simulation.track().course[pass.row].sin_cos();
    let [north_m, east_m] = [0, 1].map(|axis| place_m[axis] - iron.dipole.place_m[axis]);
    let off_m = [cos * north_m + sin * east_m, cos * east_m - sin * north_m];
    off_m.iter().all(|m| m.is_finite()).then_some(off_m)
}

/// The outcomes of tows that are drawn from seeds, and how many surveys failed.
pub(super) fn all(part: &str, seeds: Range<u64>, drawn: fn(u64) -> Drawn) -> (Vec<Outcome>, usize) {
    let folder = Folder::new(part);
    let run = |seed| outcome(&folder, seed, &drawn(seed)).map_err(|error| println!("failed: seed {seed}: {error}"));
    let all: Vec<Result<Outcome, ()>> = seeds.into_par_iter().map(run).collect();
    let failed = all.iter().filter(|outcome| outcome.is_err()).count();
    (all.into_iter().flatten().collect(), failed)
}

/// Dipoles of a signal to noise, those of an outcome by number.
pub(super) fn of_snr(snr: Range<f64>) -> impl Fn(&Outcome, usize) -> bool {
    move |outcome, dipole| snr.contains(&outcome.iron[dipole].snr())
}

/// How many are found of the dipoles that count.
pub(super) fn found(
    title: &str,
    outcomes: &[&Outcome],
    asked: [f64; 2],
    counts: impl Fn(&Outcome, usize) -> bool,
) -> Figure {
    let mut hits = Vec::new();
    for outcome in outcomes {
        let of = outcome.matched.of.iter().enumerate().filter(|(dipole, _)| counts(outcome, *dipole));
        hits.extend(of.map(|(_, of)| !of.is_empty()));
    }
    let (hit, of) = (hits.iter().filter(|hit| **hit).count(), hits.len());
    let [value, low, high] = share(hit, of);
    Figure::new(title, [value, asked[0], asked[1]], format!("{hit} of {of}, {low:.3} to {high:.3}"))
}

/// How many surveys failed.
pub(super) fn failures(outcomes: &[Outcome], failed: usize) -> Figure {
    Figure::new("Surveys that failed", [failed as f64, 0.0, 0.0], format!("of {}", outcomes.len() + failed))
}

/// What is found in the tows of a name, and what is false.
pub(super) fn found_and_false(name: &str, of: &[&Outcome]) -> [Figure; 2] {
    let title = format!("- {name}: found at SNR 8 and more");
    [
        found(&title, of, FREE, of_snr(FOUND_FROM..f64::INFINITY)),
        false_ones(&format!("- {name}: false in an hour"), of, FREE[1]),
    ]
}

/// The same by motion.
pub(super) fn by_motion(outcomes: &[Outcome]) -> Vec<Figure> {
    let of = |motion| {
        let of: Vec<&Outcome> = outcomes.iter().filter(|outcome| outcome.motion == motion).collect();
        found_and_false(motion, &of)
    };
    ["lake", "sea", "land"].into_iter().flat_map(of).collect()
}

pub(super) fn false_ones(title: &str, outcomes: &[&Outcome], most: f64) -> Figure {
    let count = outcomes.iter().map(|outcome| outcome.matched.false_ones.len()).sum();
    let hours = outcomes.iter().map(|outcome| outcome.hours).sum();
    let [value, low, high] = rate(count, hours);
    Figure::new(title, [value, FREE[0], most], format!("{count} in {hours:.1} h, {low:.2} to {high:.2}"))
}

/// A measured value of a contact, its interval and the truth.
struct Measured {
    value: [f64; 3],
    truth: f64,
}

fn measured(outcomes: &[&Outcome]) -> [Vec<Measured>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    for outcome in outcomes.iter().filter(|outcome| outcome.knows != Knows::Neither) {
        for (iron, of) in outcome.iron.iter().zip(&outcome.matched.of) {
            let Some((pass, contact)) = best(of).filter(|_| iron.snr() >= MEASURED_FROM) else { continue };
            all[0].push(Measured { value: contact.distance_m, truth: pass.distance_m });
            all[1].push(Measured { value: contact.moment_am2, truth: iron.moment_am2() });
        }
    }
    all
}

/// Error of the distance, and whether the intervals hold: three figures.
fn measures(outcomes: &[&Outcome]) -> Vec<Figure> {
    let [distance, moment] = measured(outcomes);
    let error = |of: &Measured| if of.value[0].is_nan() { f64::INFINITY } else { (of.value[0] / of.truth - 1.0).abs() };
    let errors: Vec<f64> = distance.iter().map(error).collect();
    let median = quantile(errors, 0.5);
    let mut figures =
        vec![Figure::new("Distance: median error", [median, FREE[0], 0.1], format!("{} contacts", distance.len()))];
    for (name, all) in [("distance", distance), ("moment", moment)] {
        let hit = all.iter().filter(|of| holds(of.value, of.truth)).count();
        let below = all.iter().filter(|of| of.truth < of.value[1]).count();
        let [value, low, high] = share(hit, all.len());
        let of = format!("{hit} of {}, {low:.3} to {high:.3}; truth below {below}", all.len());
        figures.push(Figure::new(format!("95 % intervals of the {name} hold"), [value, 0.92, 0.98], of));
    }
    figures
}

/// 68 % of the errors, which is one standard deviation if they are normal.
pub(super) fn along(title: &str, outcomes: &[Outcome], knows: Knows, most: f64) -> Figure {
    let errors = outcomes.iter().filter(|outcome| outcome.knows == knows).flat_map(|outcome| {
        let dipoles = outcome.iron.iter().zip(&outcome.matched.of).zip(&outcome.off_m);
        // A contact without a place, where there is one, is as far off as can be.
        dipoles
            .filter(|((iron, of), _)| iron.snr() >= MEASURED_FROM && !of.is_empty())
            .map(|(_, off_m)| off_m.map_or(f64::INFINITY, |[ahead_m, _]| ahead_m.abs()))
    });
    let errors: Vec<f64> = errors.collect();
    let (half, highest) = (quantile(errors.clone(), 0.5), quantile(errors.clone(), 0.95));
    let of = format!("{} contacts; median {half:.3}, 95 % below {highest:.3}", errors.len());
    Figure::new(title, [quantile(errors, 0.68), FREE[0], most], of)
}

/// What a person would look at next.
pub(super) fn list(outcomes: &[Outcome]) {
    for outcome in outcomes {
        let Outcome { seed, motion, .. } = outcome;
        for (iron, _) in outcome.iron.iter().zip(&outcome.matched.of).filter(|(_, of)| of.is_empty()) {
            let (pass, snr) = iron.best_pass().unwrap();
            if snr >= MEASURED_FROM {
                println!(
                    "missed: seed {seed} ({motion}) at {:.1} s, {:.1} m, SNR {snr:.1}, {:.1} beside the body",
                    pass.time_s,
                    pass.distance_m,
                    iron.snr_beside()
                );
            }
        }
        for contact in &outcome.matched.false_ones {
            println!("false: seed {seed} ({motion}) at {:.1} s, SNR {:.1}", contact.time_s, contact.snr);
        }
    }
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn contacts() {
    let begin = Instant::now();
    let (outcomes, failed) = all("contacts", program::seeds(701..1101), tow);
    list(&outcomes);
    let every: Vec<&Outcome> = outcomes.iter().collect();
    let mut figures = vec![
        failures(&outcomes, failed),
        found("Found at SNR 8 and more", &every, [0.95, FREE[1]], of_snr(FOUND_FROM..f64::INFINITY)),
        found("- at 8 to 15", &every, FREE, of_snr(FOUND_FROM..MEASURED_FROM)),
        found("- at 15 to 50", &every, FREE, of_snr(MEASURED_FROM..50.0)),
        found("- at 50 and more", &every, FREE, of_snr(50.0..f64::INFINITY)),
        false_ones("False in an hour", &every, 1.0),
    ];
    figures.extend(by_motion(&outcomes));
    let stated = mean(&outcomes.iter().map(|outcome| outcome.stated_per_hour).collect::<Vec<_>>());
    let count = outcomes.iter().map(|outcome| outcome.matched.false_ones.len()).sum();
    let [value, low, high] = rate(count, outcomes.iter().map(|outcome| outcome.hours).sum());
    let of = format!("stated {stated:.3}, {:.2} to {:.2}", low / stated, high / stated);
    figures.push(Figure::new("False contacts over the stated rate", [value / stated, 0.5, 2.0], of));
    figures.push(along("Position along the track, 68 % below, m", &outcomes, Knows::Position, 0.5));
    figures.push(along("- from the ship's position", &outcomes, Knows::Ship, FREE[1]));
    figures.extend(measures(&every));
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Contacts", &figures);
}
