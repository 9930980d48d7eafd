//! Contacts of tows whose iron lies in groups: how near it may be to be told apart.
//!
//! Seeds, options and lists are those of the [contacts](super::contacts); the tows are other ones. Each dipole is counted where its
//! pass that tells most is so near the pass of another, over the mean of both distances.

use std::ops::Range;
use std::time::Instant;

use super::contacts::{Outcome, all, failures, false_ones, found, list};
use super::draw::tow_with_groups;
use super::program;
use super::score::{FOUND_FROM, SEEN_FROM};
use super::table::{FREE, finish};
use super::truth::Pass;

/// From the pass of a dipole that tells most to the nearest of the others, over the mean of both distances.
fn apart(outcome: &Outcome, of: usize) -> f64 {
    let Some((own, _)) = outcome.iron[of].best_pass() else { return f64::MAX };
    let others = outcome.iron.iter().enumerate().filter(|(other, _)| *other != of);
    let passes = others.flat_map(|(_, iron)| iron.passes.iter()).filter(|(_, snr)| *snr >= SEEN_FROM);
    let apart = |other: &Pass| {
        (other.time_s - own.time_s).abs() * outcome.speed_m_per_s / (0.5 * (other.distance_m + own.distance_m))
    };
    passes.map(|(pass, _)| apart(pass)).fold(f64::MAX, f64::min)
}

/// Dipoles that have to be found, so near to others.
fn so_near(distances: Range<f64>) -> impl Fn(&Outcome, usize) -> bool {
    move |outcome, dipole| outcome.iron[dipole].snr() >= FOUND_FROM && distances.contains(&apart(outcome, dipole))
}

#[test]
#[ignore = "minutes, and the survey; see the top of survey_trial.rs"]
fn groups() {
    let begin = Instant::now();
    let (outcomes, failed) = all("groups", program::seeds(701..1101), tow_with_groups);
    list(&outcomes);
    let mut figures = vec![failures(&outcomes, failed)];
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
            figures.push(found(&format!("- {motion}: found, {title} distances apart"), &of, FREE, so_near(distances)));
        }
        figures.push(false_ones(&format!("- {motion}: false in an hour"), &of, FREE[1]));
    }
    println!("{} tows, {:.0} s", outcomes.len(), begin.elapsed().as_secs_f64());
    finish("Contacts in groups", &figures);
}
