//! Contacts where lines beside each other pass the same iron: where each is put on the map, and whether it is one contact.
//!
//! Serpentines of 200 m lines, 8, 12 or 20 m apart, on the lake and at sea, with depth and positions of the body by one of three receivers.
//! Seven dipoles of 2 to 60 A m^2 lie anywhere between the first and the last line, 3 to 6 m below the body, 9 m of way along the lines
//! from each other. Seeds are those of the [contacts](super::contacts); the tows are other ones.

use std::time::Instant;

use host_sim::simulator::scenario::{Columns, DipoleSpec, Motion, Scenario, Simulation};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::contacts::{Outcome, all, best, failures, false_ones, found, list, of_snr, record};
use super::draw::{Drawn, Knows, LAKE, SEA, around, in_any_direction};
use super::program::{self, Folder};
use super::receivers::Receiver;
use super::score::{FOUND_FROM, MEASURED_FROM};
use super::statistics::{mean, quantile, share};
use super::table::{FREE, Figure, finish};
use super::zero_phase::RATE_HZ;

const LINE_M: f64 = 200.0;
/// Lines, and how far apart they are, m.
const LINES: [(usize, f64); 3] = [(9, 8.0), (7, 12.0), (5, 20.0)];
/// How far a turn of half a circle takes a body to the side, over its way: the mean of `sin(PI u^3 (10 - 15 u + 6 u^2))`, as turns begin and end
/// smoothly.
const ABEAM_OF_A_TURN: f64 = 0.4076;
const DIPOLES: usize = 7;
const APART_M: f64 = 9.0;

const RECEIVERS: [Receiver; 3] = [
    Receiver { name: "1 Hz, 0.02 m", held_rows: 10, noise_m: 0.02, wander_m: 0.0, wander_s: 120.0 },
    Receiver {
        name: "1 Hz, 0.5 m, 0.3 m over two minutes",
        held_rows: 10,
        noise_m: 0.5,
        wander_m: 0.3,
        wander_s: 120.0,
    },
    Receiver { name: "1 Hz, 1 m, 1 m over two minutes", held_rows: 10, noise_m: 1.0, wander_m: 1.0, wander_s: 120.0 },
];

/// Of a seed: spacings take turns with seeds, receivers with threes of them.
fn lines(seed: u64) -> (usize, f64) {
    LINES[(seed % 3) as usize]
}

fn receiver(seed: u64) -> Receiver {
    RECEIVERS[(seed / 3 % 3) as usize]
}

fn grid(seed: u64) -> Drawn {
    let mut draw = ChaCha8Rng::seed_from_u64(seed ^ 0x6772_6964_0000_0000);
    let (motion, preset) = [("lake", LAKE), ("sea", SEA)][(seed / 9 % 2) as usize];
    let mut scenario = Scenario::parse(preset).unwrap();
    scenario.columns = Columns { position: true, depth: true, line: draw.random_bool(0.5), ..Columns::default() };
    around(&mut scenario.scalar.noise_rms_nt, &mut draw);
    around(&mut scenario.fluxgate.noise_rms_nt, &mut draw);
    let speed_m_per_s = draw.random_range(1.2..2.5);
    let (count, spacing_m) = lines(seed);
    let tow = match &mut scenario.motion {
        Motion::LakeTow { tow, speed_m_per_s: speed, .. } => {
            *speed = Some(speed_m_per_s);
            tow
        }
        Motion::SeaTow { tow, speed_m_per_s: speed, wave_from_deg, .. } => {
            *speed = speed_m_per_s;
            *wave_from_deg = draw.random_range(0.0..360.0);
            tow
        }
        Motion::LandCalibration { .. } => unreachable!("a preset of a tow"),
    };
    tow.first_heading_deg = draw.random_range(0.0..360.0);
    (tow.leg_s, tow.turn_s) = (LINE_M / speed_m_per_s, spacing_m / ABEAM_OF_A_TURN / speed_m_per_s);
    (tow.turn_deg, tow.alternates) = (180.0, true);
    scenario.duration_s = (count as f64 * (tow.leg_s + tow.turn_s) - tow.turn_s).floor();
    bury(&mut scenario, seed, &mut draw);
    Drawn { motion, knows: Knows::Position, scenario, receiver: Some(receiver(seed)) }
}

/// Dipoles between the lines: each abeam of the first line at its own place, so far to the side where the others are.
fn bury(scenario: &mut Scenario, seed: u64, draw: &mut ChaCha8Rng) {
    let speed_m_per_s = scenario.motion.speed_m_per_s().unwrap();
    let (count, spacing_m) = lines(seed);
    let bare = Simulation::new(scenario, seed).unwrap();
    let at_m = |way_m: f64| bare.track().place_m[(way_m / speed_m_per_s * RATE_HZ) as usize];
    // The side to which the tow turns: where the second line lies.
    let (sin, cos) = bare.track().course[0].sin_cos();
    let [first, second] = [0.5, 1.5].map(|lines| at_m(lines * LINE_M + lines.floor() * spacing_m / ABEAM_OF_A_TURN));
    let side = (cos * (second[1] - first[1]) - sin * (second[0] - first[0])).signum();
    let mut taken: Vec<f64> = Vec::new();
    while taken.len() < DIPOLES {
        let along_m = draw.random_range(0.075 * LINE_M..0.925 * LINE_M);
        if taken.iter().any(|other: &f64| (other - along_m).abs() < APART_M) {
            continue;
        }
        taken.push(along_m);
        let moment_am2 = in_any_direction(2.0_f64.powf(draw.random_range(1.0..60.0_f64.log2())), draw);
        scenario.dipoles.push(DipoleSpec {
            moment_am2,
            inclination_deg: None,
            declination_deg: None,
            at_s: Some(along_m / speed_m_per_s),
            offset_m: Some(side * draw.random_range(0.0..(count - 1) as f64 * spacing_m)),
            below_m: Some(draw.random_range(3.0..6.0)),
            latitude_deg: None,
            longitude_deg: None,
            depth_m: None,
        });
    }
}

/// How far contacts are off on the map that were passed so often, of a signal to noise of 15 and more.
fn places(title: &str, outcomes: &[&Outcome], counts: impl Fn(f64) -> bool) -> Figure {
    let off_m = |outcome: &&Outcome| {
        let dipoles = outcome.iron.iter().zip(&outcome.matched.of).zip(&outcome.off_m);
        let counted = dipoles.filter(|((iron, of), _)| {
            iron.snr() >= MEASURED_FROM && best(of).is_some_and(|(_, contact)| counts(contact.passes))
        });
        counted.map(|(_, off_m)| off_m.map_or(f64::INFINITY, |[ahead, abeam]| ahead.hypot(abeam))).collect::<Vec<_>>()
    };
    let off_m: Vec<f64> = outcomes.iter().flat_map(off_m).collect();
    let (most, highest) = (quantile(off_m.clone(), 0.8), quantile(off_m.clone(), 0.95));
    let of = format!("{} contacts; 80 % below {most:.2}, 95 % below {highest:.2}", off_m.len());
    Figure::new(title, [quantile(off_m, 0.5), FREE[0], FREE[1]], of)
}

/// Contacts more than one of a dipole, over dipoles.
fn told_twice(title: &str, outcomes: &[&Outcome]) -> Figure {
    let of = || outcomes.iter().flat_map(|outcome| &outcome.matched.of).filter(|of| !of.is_empty());
    let more: Vec<f64> = of().map(|of| (of.len() - 1) as f64).collect();
    let of = format!("{} of {}", more.iter().sum::<f64>(), more.len());
    Figure::new(title, [mean(&more), FREE[0], FREE[1]], of)
}

#[test]
fn lines_lie_as_far_apart_as_they_say_and_pass_the_iron_between_them() {
    for seed in [0, 1, 11] {
        let Drawn { scenario, .. } = grid(seed);
        let simulation = Simulation::new(&scenario, seed).unwrap();
        let track = simulation.track();
        let (sin, cos) = track.course[0].sin_cos();
        let across =
            |place_m: &[f64; 3]| cos * (place_m[1] - track.place_m[0][1]) - sin * (place_m[0] - track.place_m[0][0]);
        let (count, spacing_m) = lines(seed);
        let last_m = across(track.place_m.last().unwrap());
        assert!((last_m.abs() - (count - 1) as f64 * spacing_m).abs() < 0.5, "{seed}: {last_m} m");
        assert_eq!(track.dipoles.len(), DIPOLES);
        for dipole in &track.dipoles {
            let share = across(&dipole.place_m) / last_m;
            assert!((-0.05..1.05).contains(&share), "{seed}: {share} of the way across");
        }
    }
}

/// Whether a grid is told a gap: it has none.
fn verdict(folder: &Folder, seed: u64) -> String {
    let (drawn, recording) = (grid(seed), folder.file(&format!("{seed}.csv")));
    let simulation = Simulation::new(&drawn.scenario, seed).unwrap();
    record(&simulation, &drawn, seed, &recording).unwrap();
    let out = folder.file(&format!("{seed}_diagnosis"));
    program::run(&["diagnose", program::text(&recording), "--out", program::text(&out)]).unwrap();
    program::json(&out.join("diagnosis.json"))["verdict"].as_str().unwrap().into()
}

#[test]
#[ignore = "minutes, and the diagnosis; see the top of survey_trial.rs"]
fn diagnosed() {
    let folder = Folder::new("grids_diagnosed");
    let seeds = program::seeds(701..791);
    let verdicts: Vec<(u64, String)> = seeds.map(|seed| (seed, verdict(&folder, seed))).collect();
    let told: Vec<_> = verdicts.iter().filter(|(_, verdict)| verdict != "no_gap").collect();
    told.iter().for_each(|(seed, verdict)| println!("told a gap: seed {seed}: {verdict}"));
    let [value, low, high] = share(told.len(), verdicts.len());
    let of = format!("{} of {}, {low:.3} to {high:.3}", told.len(), verdicts.len());
    finish("Grids of lines, which have no gap", &[Figure::new("Told a gap", [value, FREE[0], 0.01], of)]);
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn grids() {
    let begin = Instant::now();
    let (outcomes, failed) = all("grids", program::seeds(701..791), grid);
    list(&outcomes);
    let mut figures = vec![failures(&outcomes, failed)];
    let kinds = [("all", None)].into_iter().chain(RECEIVERS.into_iter().map(|own| (own.name, Some(own))));
    for (name, own) in kinds {
        let of: Vec<&Outcome> =
            outcomes.iter().filter(|outcome| own.is_none_or(|own| receiver(outcome.seed) == own)).collect();
        figures.push(found(&format!("{name}: found at SNR 8 and more"), &of, FREE, of_snr(FOUND_FROM..f64::INFINITY)));
        figures.push(places("- by two and more passes: off, median, m", &of, |passes| passes > 1.0));
        figures.push(places("- by one pass: off, median, m", &of, |passes| passes == 1.0));
        figures.push(told_twice("- contacts more than one of a dipole", &of));
        figures.push(false_ones("- false in an hour", &of, FREE[1]));
    }
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Contacts of grids of lines", &figures);
}
