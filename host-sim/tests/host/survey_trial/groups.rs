//! Contacts of tows whose iron lies in groups: how near it may be to be told apart.
//!
//! Seeds, options and lists are those of the [contacts](super::contacts); the tows are other ones. Each dipole is counted where its
//! pass that tells most is so near the pass of another, over the mean of both distances.

use std::ops::Range;
use std::time::Instant;

use super::contacts::{Outcome, all, false_ones, list};
use super::draw::tow_with_groups;
use super::program;
use super::score::{FOUND_FROM, SEEN_FROM};
use super::statistics::share;
use super::table::{FREE, Figure, finish};
use super::truth::{Iron, Pass};

/// From the pass of a dipole that tells most to the nearest of the others, over the mean of both distances.
fn apart(outcome: &Outcome, of: usize) -> f64 {
    let most = |iron: &Iron| iron.passes.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(pass, _)| *pass);
    let Some(own) = most(&outcome.iron[of]) else { return f64::MAX };
    let others = outcome.iron.iter().enumerate().filter(|(other, _)| *other != of);
    let passes = others.flat_map(|(_, iron)| iron.passes.iter()).filter(|(_, snr)| *snr >= SEEN_FROM);
    let apart = |other: &Pass| {
        (other.time_s - own.time_s).abs() * outcome.speed_m_per_s / (0.5 * (other.distance_m + own.distance_m))
    };
    passes.map(|(pass, _)| apart(pass)).fold(f64::MAX, f64::min)
}

fn found(title: &str, outcomes: &[&Outcome], distances: Range<f64>) -> Figure {
    let mut hits = Vec::new();
    for outcome in outcomes {
        let all = outcome.iron.iter().zip(&outcome.matched.of).enumerate();
        let of = all.filter(|(k, (iron, _))| iron.snr() >= FOUND_FROM && distances.contains(&apart(outcome, *k)));
        hits.extend(of.map(|(_, (_, of))| !of.is_empty()));
    }
    let (hit, of) = (hits.iter().filter(|hit| **hit).count(), hits.len());
    let [value, low, high] = share(hit, of);
    Figure::new(title, [value, FREE[0], FREE[1]], format!("{hit} of {of}, {low:.3} to {high:.3}"))
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn groups() {
    let begin = Instant::now();
    let (outcomes, failed) = all("groups", program::seeds(701..1101), tow_with_groups);
    list(&outcomes);
    let mut figures =
        vec![Figure::new("Surveys that failed", [failed as f64, 0.0, 0.0], format!("of {}", outcomes.len() + failed))];
    let every: Vec<&Outcome> = outcomes.iter().collect();
    for motion in ["all", "lake", "sea", "land"] {
        let of: Vec<&Outcome> =
            every.iter().copied().filter(|outcome| motion == "all" || outcome.motion == motion).collect();
        for (title, distances) in [
            ("below 2", 0.0..2.0),
            ("2 to 3", 2.0..3.0),
            ("3 to 5", 3.0..5.0),
            ("5 and more", 5.0..f64::INFINITY),
            ("any", 0.0..f64::INFINITY),
        ] {
            figures.push(found(&format!("- {motion}: found, {title} distances apart"), &of, distances));
        }
        figures.push(false_ones(&format!("- {motion}: false in an hour"), &of, FREE[1]));
    }
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Contacts in groups", &figures);
}
