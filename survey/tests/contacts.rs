//! Contacts in simulated tows.
#![cfg(not(target_os = "none"))]

mod simulated;

use rayon::prelude::*;
use simulated::{Colours, LAKE, Random, SEA, Straight, Target};
use towmag_survey::contacts::{Found, Options, Pass, find, merge, smallest_moments_am2};
use towmag_survey::navigation::Grid;
use towmag_survey::{Contact, Estimate, SurveyedTow};

fn target(along_m: f64, distance_m: f64, side_rad: f64, moment: [f64; 3]) -> Target {
    Target { along_m, distance_m, side_rad, moment }
}

fn search(tow: &Straight) -> Found {
    find(&tow.levelled(), &Options::default())
}

fn is_near(found: &Found, along_m: f64) -> bool {
    found.passes.iter().any(|pass| (pass.at.value - along_m).abs() < 2.0)
}

/// The one strong contact of a tow past a target, and by how much its anomaly is off at most, nT.
fn passed(seed: u64, one: Target) -> (Pass, f64) {
    let tow = Straight::new(&mut Random::new(seed), 6000, 2.0, &LAKE, vec![one]);
    let found = search(&tow);
    let (real, chance): (Vec<&Pass>, Vec<&Pass>) = found.passes.iter().partition(|pass| pass.snr > 10.0);
    assert!(real.len() == 1 && chance.iter().all(|pass| pass.false_alarm_probability > 0.1), "{:?}", found.passes);
    let pass = real[0].clone();
    let off = |(way, nt): (&f64, f64)| (nt - one.anomaly_nt(*way, tow.direction[0])).abs();
    let most = pass.way.iter().zip(pass.anomaly_nt.iter().copied()).map(off).fold(0.0, f64::max);
    (pass, most)
}

#[test]
fn a_fit_is_the_dipole_law() {
    let one = target(600.0, 6.0, 0.6, [4.0, -6.0, 8.0]);
    let (pass, most) = passed(0, one);
    assert!(most < 0.06 * pass.peak_nt.abs(), "{most} nT of {}", pass.peak_nt);
    let moment = pass.moment_am2.expect("the way is in metres");
    assert!(moment.low < one.moment_am2() && one.moment_am2() < moment.high, "{moment:?}");
    assert!((pass.distance.value / 6.0 - 1.0).abs() < 0.1, "{:?}", pass.distance);
}

/// On the flanks of strong iron half a row is far more than the noise.
#[test]
fn a_reading_that_is_missing_beside_strong_iron_changes_nothing() {
    let one = target(600.0, 7.0, 0.6, [20.0, -30.0, 40.0]);
    [2_988, 2_996, 2_999, 3_004, 3_011].into_par_iter().for_each(|missing| {
        let mut tow = Straight::new(&mut Random::new(0), 6000, 2.0, &LAKE, vec![one]);
        tow.is_valid[missing] = false;
        let found = search(&tow);
        let [pass] = &found.passes[..] else { panic!("{missing}: {:?}", found.passes) };
        assert!((pass.distance.value / 7.0 - 1.0).abs() < 0.05, "{missing}: {:?}", pass.distance);
    });
}

/// It differs from seed to seed, and with it how well an anomaly is told.
#[test]
fn beside_slow_rock_a_fit_is_as_good_as_its_signal_to_noise() {
    (0..6).into_par_iter().for_each(|seed| {
        let (pass, most) = passed(seed, target(600.0, 6.0, 0.6, [4.0, -6.0, 8.0]));
        assert!(most < 8.0 * pass.peak_nt.abs() / pass.snr, "{seed}: {most} nT of {}, {}", pass.peak_nt, pass.snr);
        assert!((pass.distance.value / 6.0 - 1.0).abs() < 0.1, "{seed}: {:?}", pass.distance);
    });
}

/// Strong iron and slow rock make the other seven of ten that are stated.
#[test]
fn noise_alone_has_three_in_ten_of_the_contacts_that_are_stated() {
    let (hours, stated) = (8, 10.0);
    for (name, colours) in [("lake", LAKE), ("sea", SEA)] {
        let count = |seed: u64| {
            let tow = Straight::new(&mut Random::new(100 + seed), 36_000, 2.0, &colours, vec![]);
            find(&tow.levelled(), &Options { false_alarms_per_hour: stated, ..Options::default() }).passes.len()
        };
        let rate = (0..hours).into_par_iter().map(count).sum::<usize>() as f64 / hours as f64;
        assert!((0.15 * stated..0.6 * stated).contains(&rate), "{name}: {rate} an hour");
    }
}

/// Of 70 targets that stand well apart: found, and held by the intervals of distance and moment.
#[test]
fn targets_are_found_and_intervals_hold_them() {
    let of_seed = |seed: u64| {
        let mut random = Random::new(200 + seed);
        let targets = (1..6).map(|k| Target::random(&mut random, 300.0 * f64::from(k))).collect();
        let tow = Straight::new(&mut random, 9000, 2.0, &SEA, targets);
        let found = search(&tow);
        let of = |target: &Target| {
            let row = tow.track.along_m.partition_point(|m| *m < target.along_m);
            let about = &tow.track.along_m[row - 500..row + 500];
            let anomaly: Vec<f64> = about.iter().map(|m| target.anomaly_nt(*m, tow.direction[0])).collect();
            let near = |pass: &&Pass| (pass.at.value - target.along_m).abs() < target.distance_m;
            let pass = found.passes.iter().find(near);
            let holds = |e: Estimate, x: f64| e.low <= x && x <= e.high;
            let is_held = pass.map(|pass| {
                let moment = pass.moment_am2.expect("the way is in metres");
                [holds(pass.distance, target.distance_m), holds(moment, target.moment_am2())]
            });
            (found.noise.snr(row, &anomaly), is_held)
        };
        tow.targets.iter().map(of).collect::<Vec<_>>()
    };
    let all: Vec<(f64, Option<[bool; 2]>)> = (0..14).into_par_iter().flat_map_iter(of_seed).collect();
    let strong: Vec<_> = all.iter().filter(|(snr, _)| *snr >= 8.0).collect();
    let found: Vec<[bool; 2]> = strong.iter().filter_map(|(_, held)| *held).collect();
    assert!(
        strong.len() > 30 && found.len() as f64 >= 0.95 * strong.len() as f64,
        "{} of {}",
        found.len(),
        strong.len()
    );
    for k in 0..2 {
        let share = found.iter().filter(|held| held[k]).count() as f64 / found.len() as f64;
        assert!(share >= 0.8, "interval {k} holds {share}");
    }
}

#[test]
fn a_false_reading_a_step_and_what_a_turn_leaves_are_no_contacts() {
    let mut tow =
        Straight::new(&mut Random::new(3), 12_000, 2.0, &LAKE, vec![target(1800.0, 4.0, 0.0, [0.0, 3.0, 6.0])]);
    tow.field_nt[2000] += 3.0;
    tow.field_nt[4000..].iter_mut().for_each(|nt| *nt += 1.0);
    // A turn of half a circle in 40 s changes each term; compensation has left a little of some.
    for row in 0..tow.terms.len() {
        let turned = ((row as f64 - 6400.0) / 400.0).clamp(0.0, 1.0) * std::f64::consts::PI;
        let (sin, cos) = turned.sin_cos();
        let terms = [cos, sin, cos * cos, cos * sin];
        terms.iter().enumerate().for_each(|(k, term)| tow.terms[row][k] = 10.0 * term);
        tow.field_nt[row] += 0.4 * cos - 0.3 * sin + 0.5 * cos * sin;
    }
    let found = search(&tow);
    let places: Vec<f64> = found.passes.iter().map(|pass| pass.time_s).collect();
    assert!(is_near(&found, 1800.0), "{places:?}");
    for time_s in [200.0, 400.0, 640.0, 660.0, 680.0] {
        // The weakest of what a turn leaves, at its corners, cannot be told from a weak target by the evidence for 18 terms.
        let is_clear = |pass: &Pass| pass.snr > 8.0 && (pass.time_s - time_s).abs() < 15.0;
        assert!(!found.passes.iter().any(is_clear), "{:?}", found.passes);
    }
}

/// Rock 25 s away is as smooth as a dipole; what is looked for is at most 15 s away.
#[test]
fn a_dipole_beyond_the_distances_that_are_looked_for_is_no_contact() {
    let at = |distance_m: f64, moment: f64| {
        let wide = target(1200.0, distance_m, 0.0, [0.0, 0.3 * moment, moment]);
        search(&Straight::new(&mut Random::new(5), 12_000, 2.0, &SEA, vec![wide])).passes
    };
    let is_found = |passes: &[Pass]| passes.iter().any(|pass| pass.snr > 8.0);
    let (inside, beyond) = (at(20.0, 400.0), at(50.0, 40_000.0));
    assert!(is_found(&inside) && !is_found(&beyond), "{inside:?} {beyond:?}");
}

/// Where it is not taken off, it is in the noise of minutes.
#[test]
fn strong_iron_by_an_end_is_no_contact_and_hides_no_other() {
    let (by_end, weak) = (target(9.0, 5.0, 0.0, [0.0, 150.0, 300.0]), target(90.0, 4.0, 0.0, [0.0, 0.3, 0.6]));
    let found = search(&Straight::new(&mut Random::new(8), 6000, 2.0, &LAKE, vec![by_end, weak]));
    assert!(is_near(&found, 90.0) && !is_near(&found, 9.0), "{:?}", found.passes);
}

#[test]
fn two_that_are_three_widths_apart_are_two() {
    let pair = vec![target(600.0, 4.0, 0.0, [0.0, 3.0, 6.0]), target(614.0, 4.0, 0.3, [5.0, -3.0, 2.0])];
    let found = search(&Straight::new(&mut Random::new(4), 6000, 2.0, &LAKE, pair));
    assert!(found.passes.len() == 2 && is_near(&found, 600.0) && is_near(&found, 614.0), "{:?}", found.passes);
}

/// What the one that is not taken off yet leaves, many terms explain better than one dipole does.
#[test]
fn strong_iron_beside_strong_iron_is_found_too() {
    let tows: Vec<(u64, f64)> = (0..8).flat_map(|seed| [10.0, 14.0, 24.0].map(|apart_m| (seed, apart_m))).collect();
    let is_missed = |(seed, apart_m): &(u64, f64)| {
        let pair = vec![target(600.0, 4.0, 0.0, [0.0, 3.0, 6.0]), target(600.0 + apart_m, 4.0, 0.3, [5.0, -3.0, 2.0])];
        let found = search(&Straight::new(&mut Random::new(*seed), 6000, 2.0, &LAKE, pair));
        !is_near(&found, 600.0) || !is_near(&found, 600.0 + apart_m)
    };
    let missed: Vec<(u64, f64)> = tows.into_par_iter().filter(is_missed).collect();
    assert!(missed.is_empty(), "{missed:?}");
}

fn surveyed(tow: &Straight, east_m: f64) -> SurveyedTow {
    let mut track = tow.track.clone();
    track.easting_m.iter_mut().for_each(|m| *m += east_m);
    let line = vec![format!("L{east_m}").into(); tow.time_s.len()];
    SurveyedTow { time_s: tow.time_s.clone(), track: Some(track), line, ..SurveyedTow::default() }
}

/// Contacts of lines to the north at these eastings, with one object at 8 m, 6 m below.
fn contacts_of_lines(east_m: &[f64]) -> Vec<Contact> {
    // Of one seed, as the Earth's field is the same for all.
    let of = |east_m: &f64| {
        let side_m = 8.0 - east_m;
        let one = target(600.0, 6.0_f64.hypot(side_m), (side_m / 6.0).atan(), [2.0, 5.0, 20.0]);
        Straight::new(&mut Random::new(5), 6000, 2.0, &LAKE, vec![one])
    };
    let lines: Vec<Straight> = east_m.iter().map(of).collect();
    let found: Vec<Found> = lines.iter().map(search).collect();
    let tows: Vec<SurveyedTow> = lines.iter().zip(east_m).map(|(line, east_m)| surveyed(line, *east_m)).collect();
    merge(
        &tows.iter().zip(&found).map(|(tow, found)| (tow, found.passes.as_slice())).collect::<Vec<_>>(),
        Grid::of(45.0, 9.0),
    )
}

#[test]
fn two_lines_tell_the_side() {
    // Either side of it; and both on one side of it, where moments must tell what distances do not.
    for lines in [[0.0, 12.0], [0.0, 5.0], [12.0, 16.0]] {
        let contacts = contacts_of_lines(&lines);
        assert!(contacts.len() == 1 && contacts[0].passes == 2, "{lines:?}: {contacts:?}");
        let place = contacts[0].place.expect("there is a track");
        let off = (place.easting_m - 8.0).hypot(place.northing_m - 600.0);
        assert!(off < 1.0, "{lines:?}: {off} m, {place:?}");
    }
}

/// The way back along a line to the north, which it was made as.
fn back(mut tow: Straight) -> Straight {
    tow.field_nt.reverse();
    tow.terms.reverse();
    tow.direction.iter_mut().for_each(|[forward, starboard, _]| (*forward, *starboard) = (-*forward, -*starboard));
    tow.track.northing_m.reverse();
    let end_m = tow.track.northing_m[0];
    tow.track.along_m = tow.track.northing_m.iter().map(|m| end_m - m).collect();
    tow.track.course_deg.fill(180.0);
    tow
}

#[test]
fn an_object_by_the_end_of_two_lines_of_one_recording_is_one_contact() {
    // It is passed 32 s after it was, in less than ten widths of its anomaly.
    let (rows, end_m) = (6000, 1170.0);
    let line = |east_m: f64| {
        let side_m = 6.0 - east_m;
        let one = target(end_m, 7.0_f64.hypot(side_m), (side_m / 7.0).atan(), [2.0, 5.0, 40.0]);
        Straight::new(&mut Random::new(5), rows, 2.0, &LAKE, vec![one])
    };
    let lines = [line(0.0), back(line(12.0))];
    let [mut first, second] = [0, 1].map(|k| surveyed(&lines[k], [0.0, 12.0][k]));
    let [mut passes, mut again] = [0, 1].map(|k| search(&lines[k]).passes);
    let later_s = first.time_s[rows - 1] + 2.0;
    for pass in &mut again {
        (pass.row, pass.rows, pass.time_s) =
            (pass.row + rows, pass.rows.start + rows..pass.rows.end + rows, pass.time_s + later_s);
    }
    passes.extend(again);
    first.time_s.extend(second.time_s.iter().map(|s| s + later_s));
    first.line.extend(second.line);
    let (track, more) = (first.track.as_mut().unwrap(), second.track.unwrap());
    track.easting_m.extend(more.easting_m);
    track.northing_m.extend(more.northing_m);
    track.course_deg.extend(more.course_deg);
    let contacts = merge(&[(&first, &passes)], Grid::of(45.0, 9.0));
    assert!(contacts.len() == 1 && contacts[0].passes == 2, "{contacts:?}");
    let place = contacts[0].place.expect("there is a track");
    let off = (place.easting_m - 6.0).hypot(place.northing_m - end_m);
    assert!(off < 1.0, "{off} m, {place:?}");
}

#[test]
fn one_line_twice_tells_no_side() {
    let contacts = contacts_of_lines(&[5.0, 5.0]);
    assert!(contacts.len() == 1 && contacts[0].passes == 2, "{contacts:?}");
    let place = contacts[0].place.expect("there is a track");
    assert!((place.easting_m - 5.0).abs() < 1e-6, "on the line: {place:?}");
}

#[test]
fn the_smallest_moment_is_found_nine_times_in_ten() {
    let colours = Colours { geology_nt: 2.0, ..LAKE };
    let empty = Straight::new(&mut Random::new(7), 12_000, 2.0, &colours, vec![]);
    let moments = smallest_moments_am2(&empty.levelled(), &search(&empty), Some(5.0));
    let of_seed = |seed: u64| {
        let mut random = Random::new(300 + seed);
        let (row, ways) = (6000, [0.2, 0.35, 0.5, 0.65, 0.8].map(|share| share * 2400.0));
        let targets = ways.map(|way| target(way, 5.0, 0.0, random.direction().map(|x| moments[row] * x))).to_vec();
        let tow = Straight::new(&mut random, 12_000, 2.0, &colours, targets);
        let found = search(&tow);
        let is_found = |target: &&Target| found.passes.iter().any(|pass| (pass.at.value - target.along_m).abs() < 5.0);
        tow.targets.iter().filter(is_found).count()
    };
    let share = (0..16).into_par_iter().map(of_seed).sum::<usize>() as f64 / 80.0;
    // Three standard deviations of 80 trials.
    assert!((0.8..=1.0).contains(&share), "{share}");
}
