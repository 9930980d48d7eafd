//! Figures of the detector on simulated tows, for whoever changes it: `cargo test -p towmag-survey --test measure_contacts --
//! --ignored --nocapture`, with SEEDS="from to".
#![cfg(not(target_os = "none"))]

mod simulated;

use std::time::Instant;

use rayon::prelude::*;
use simulated::{Colours, LAKE, Random, SEA, Straight, Target};
use towmag_survey::contacts::{Options, find};

fn seeds() -> std::ops::Range<u64> {
    let text = std::env::var("SEEDS").unwrap_or_else(|_| "1000 1020".into());
    let ends: Vec<u64> = text.split_whitespace().map(|word| word.parse().expect("two whole numbers")).collect();
    ends[0]..ends[1]
}

#[test]
#[ignore = "prints figures"]
fn null_rate() {
    for (name, colours) in [("lake", LAKE), ("sea", SEA)] {
        for minutes in [20, 60] {
            let counts: Vec<(usize, [f64; 2])> = seeds()
                .into_par_iter()
                .map(|seed| {
                    let mut random = Random::new(seed);
                    let tow = Straight::new(&mut random, 600 * minutes, 2.0, &colours, vec![]);
                    let found = find(&tow.levelled(), &Options { false_alarms_per_hour: 5.0, ..Options::default() });
                    for pass in &found.passes {
                        println!(
                            "   {seed} row {} distance {:.2} snr {:.1} of {:.1}",
                            pass.row,
                            pass.dipole.distance,
                            pass.snr,
                            found.threshold.sqrt()
                        );
                    }
                    (found.passes.len(), [found.threshold, found.noise.median_floor_nt().unwrap_or(0.0)])
                })
                .collect();
            let hours = counts.len() as f64 * minutes as f64 / 60.0;
            let sum: usize = counts.iter().map(|c| c.0).sum();
            let thr = counts.iter().map(|c| c.1[0]).sum::<f64>() / counts.len() as f64;
            println!(
                "{name} {minutes} min: {sum} in {hours:.0} h, {:.2} an hour for 5; threshold {thr:.1}",
                sum as f64 / hours
            );
        }
    }
}

#[test]
#[ignore = "prints figures"]
fn targets() {
    let calm = Colours { geology_nt: 0.0, ..LAKE };
    for (name, colours) in [("calm", calm), ("lake", LAKE), ("sea", SEA)] {
        let rows: Vec<Vec<[f64; 9]>> = seeds().into_par_iter().map(|seed| of_seed(seed, &colours)).collect();
        let all: Vec<[f64; 9]> = rows.into_iter().flatten().collect();
        for [from, to] in [[3.0, 5.0], [5.0, 6.5], [6.5, 8.0], [8.0, 12.0], [12.0, 15.0], [15.0, 1e9]] {
            let of: Vec<&[f64; 9]> = all.iter().filter(|r| (from..to).contains(&r[0])).collect();
            let is_alone =
                |r: &&&[f64; 9]| r[1] > 0.0 && (from < 8.0 || std::env::var("ALONE").is_err() || r[1] == 2.0);
            let hit: Vec<&&[f64; 9]> = of.iter().filter(is_alone).collect();
            let median = |k: usize| {
                let mut v: Vec<f64> = hit.iter().map(|r| r[k]).collect();
                v.sort_by(f64::total_cmp);
                [v.get(v.len() / 2).copied().unwrap_or(0.0), v.get(v.len() * 95 / 100).copied().unwrap_or(0.0)]
            };
            let share = |k: usize| hit.iter().filter(|r| r[k] > 0.0).count() as f64 / hit.len().max(1) as f64;
            println!(
                "{name} {from}-{to}: {} of {}; at {:.2?} m; distance {:.3?}, held {:.3}; moment {:.2?} held {:.3}; ratio of moment's ends {:.1?} at held {:.3}",
                hit.len(),
                of.len(),
                median(2),
                median(3),
                share(4),
                median(5),
                share(6),
                median(7),
                share(8)
            );
        }
        println!("{name}: not targets {}", all.iter().filter(|r| r[0] < 0.0).map(|r| r[1]).sum::<f64>());
    }
}

/// Of each target: true signal to noise, found, error of place, of distance as share, held, of moment, held, ratio.
fn of_seed(seed: u64, colours: &Colours) -> Vec<[f64; 9]> {
    let mut random = Random::new(seed);
    let rows = 600 * 20;
    let speed = random.uniform(1.0, 3.0);
    let count = random.uniform(0.0, 11.0) as usize;
    let length_m = rows as f64 / 10.0 * speed;
    let targets: Vec<Target> = (0..count)
        .map(|_| {
            let along = random.uniform(0.05, 0.95) * length_m;
            Target::random(&mut random, along)
        })
        .collect();
    let tow = Straight::new(&mut random, rows, speed, colours, targets);
    let clock = Instant::now();
    let found = find(&tow.levelled(), &Options::default());
    if seed.is_multiple_of(10) {
        println!("{seed}: {:?} for {} passes", clock.elapsed(), found.passes.len());
    }
    let mut is_used = vec![false; found.passes.len()];
    let mut out = Vec::new();
    for target in &tow.targets {
        let row = tow.track.along_m.partition_point(|m| *m < target.along_m);
        let about = row.saturating_sub(1000)..(row + 1000).min(tow.time_s.len());
        let anomaly: Vec<f64> =
            tow.track.along_m[about].iter().map(|m| target.anomaly_nt(*m, tow.direction[0])).collect();
        let snr = found.noise.snr(row, &anomaly);
        let near = (0..found.passes.len()).filter(|k| !is_used[*k]).min_by(|a, b| {
            let off = |k: usize| (found.passes[k].dipole.at - target.along_m).abs();
            off(*a).total_cmp(&off(*b))
        });
        if let (Some(k), true) = (near, std::env::var("VERBOSE").is_ok() && snr > 8.0) {
            let pass = &found.passes[k];
            println!(
                "   {seed}: snr {snr:.1} {:.1} d {:.2} est {:.2} ({:.2}-{:.2}) z {:.1} at err {:.2} std {:.2} d_s {:.1}",
                pass.snr,
                target.distance_m,
                pass.distance.value,
                pass.distance.low,
                pass.distance.high,
                (target.distance_m / pass.distance.value).ln() / (pass.distance.high / pass.distance.low).ln() * 3.92,
                pass.at.value - target.along_m,
                pass.at_std,
                target.distance_m / speed
            );
        }
        let hit = near.filter(|k| (found.passes[*k].dipole.at - target.along_m).abs() < 0.7 * target.distance_m);
        let mut row = [snr, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        if let Some(k) = hit {
            is_used[k] = true;
            let pass = &found.passes[k];
            let (d, m) = (pass.distance, pass.moment_am2.expect("metres"));
            let held = |e: towmag_survey::Estimate, x: f64| f64::from(u8::from(e.low <= x && x <= e.high));
            row = [
                snr,
                if tow.targets.iter().all(|t| {
                    t.along_m == target.along_m
                        || (t.along_m - target.along_m).abs() > 5.0 * (t.distance_m + target.distance_m)
                }) {
                    2.0
                } else {
                    1.0
                },
                (pass.at.value - target.along_m).abs(),
                (d.value / target.distance_m - 1.0).abs(),
                held(d, target.distance_m),
                (m.value / target.moment_am2()).ln().abs(),
                held(m, target.moment_am2()),
                m.high / m.low,
                f64::from(u8::from(held(pass.at, target.along_m) > 0.0)),
            ];
        } else if snr > 8.0 {
            println!(
                "   {seed}: missed snr {snr:.1} at {:.1} of {length_m:.0} m, {:.1} m, speed {speed:.1}; others {:?}",
                target.along_m,
                target.distance_m,
                tow.targets
                    .iter()
                    .map(|t| ((t.along_m - target.along_m).round(), t.distance_m.round()))
                    .filter(|t| t.0.abs() < 60.0 && t.0 != 0.0)
                    .collect::<Vec<_>>()
            );
        }
        out.push(row);
    }
    for k in (0..is_used.len()).filter(|k| !is_used[*k]) {
        println!(
            "   {seed}: false at {:.1}, distance {:.1}, snr {:.1} p {:.3}",
            found.passes[k].dipole.at,
            found.passes[k].dipole.distance,
            found.passes[k].snr,
            found.passes[k].false_alarm_probability
        );
        out.push([-1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
    out
}

/// Groups of strong iron on a line, by how far apart: how many of all groups are found whole.
#[test]
#[ignore = "prints figures"]
fn groups() {
    for (count, colours) in [(2, LAKE), (2, SEA), (4, LAKE)] {
        for apart_m in [6.0, 8.0, 10.0, 14.0, 20.0, 30.0, 45.0] {
            let found: Vec<[usize; 2]> =
                seeds().into_par_iter().map(|seed| of_group(seed, count, apart_m, &colours)).collect();
            let whole = found.iter().filter(|of| of[0] == count).count();
            let [objects, others] = [0, 1].map(|k: usize| found.iter().map(|of| of[k]).sum::<usize>());
            println!(
                "{count} at {apart_m} m, sea {}: {whole} of {} whole, {objects} of {} objects, {others} others",
                colours.swell_nt > 0.0,
                found.len(),
                count * found.len()
            );
        }
    }
}

/// Of a group the objects that are found, and what is found beside them.
fn of_group(seed: u64, count: usize, apart_m: f64, colours: &Colours) -> [usize; 2] {
    let mut random = Random::new(seed);
    let targets: Vec<Target> = (0..count)
        .map(|k| {
            let size = random.uniform(4.0, 12.0);
            let moment = random.direction().map(|x| x * size);
            let (distance_m, side_rad) = (random.uniform(3.0, 5.0), random.uniform(-0.5, 0.5));
            Target { along_m: 600.0 + k as f64 * apart_m, distance_m, side_rad, moment }
        })
        .collect();
    let tow = Straight::new(&mut random, 6000, 2.0, colours, targets);
    let passes = find(&tow.levelled(), &Options::default()).passes;
    let off_m = |along_m: f64, target: &Target| (along_m - target.along_m).abs();
    let is_found = |target: &&Target| passes.iter().any(|pass| off_m(pass.at.value, target) < 2.0);
    let is_other = |along_m: f64| tow.targets.iter().all(|target| off_m(along_m, target) >= 2.0);
    [tow.targets.iter().filter(is_found).count(), passes.iter().filter(|pass| is_other(pass.at.value)).count()]
}
