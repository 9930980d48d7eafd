//! Figures that nobody asks for, each with what it was counted of.

use std::collections::BTreeSet;

use towmag_trial::{Rate, Score};

use super::confusion::name_of;
use crate::text::diagnosis as words;

pub(super) fn alarms(score: &Score) -> Vec<(String, String)> {
    let groups = [("Noise", &score.false_alarms_by_noise), ("Motion", &score.false_alarms_by_motion)];
    let row = |group: &str, name: &str, rate: &Rate| (format!("{group}: {name}"), counted(rate));
    groups.iter().flat_map(|(group, rates)| rates.iter().map(move |(name, rate)| row(group, name, rate))).collect()
}

/// Of the parameters and of the shrink, each effect by itself. A heading error has no counted parameters.
pub(super) fn intervals(score: &Score) -> Vec<(String, String)> {
    let (parameters, shrink) = (&score.intervals_cover_by_effect, &score.shrink.cover_by_effect);
    let names: BTreeSet<&String> = parameters.keys().chain(shrink.keys()).collect();
    let share = |rate: Option<&Rate>| rate.map_or("–".into(), |rate| format!("{} of {}", rate.hits, rate.of));
    let text = |name| format!("parameters {}; shrink {}", share(parameters.get(name)), share(shrink.get(name)));
    names.into_iter().map(|name| (name_of(name), text(name))).collect()
}

pub(super) fn withheld(score: &Score) -> Vec<(String, String)> {
    let Some(withheld) = &score.withheld else { return Vec::new() };
    let median = withheld.median_gap_closed.map_or("–".into(), words::percent);
    vec![
        (format!("Without {}: noticed", name_of(&withheld.name)), counted(&withheld.noticed)),
        ("Without it: explained by others".into(), counted(&withheld.explained_by_others)),
        ("With it back: right, or in the stated set".into(), counted(&withheld.named_when_back)),
        ("With it back: gap explained".into(), counted(&withheld.explained_when_back)),
        ("Share of the gap that it closes, median".into(), median),
    ]
}

fn counted(rate: &Rate) -> String {
    let [low, high] = rate.ci95.map(|end| 100.0 * end);
    if rate.of == 0 { "none drawn".into() } else { format!("{} of {} ({low:.0} to {high:.0} %)", rate.hits, rate.of) }
}
