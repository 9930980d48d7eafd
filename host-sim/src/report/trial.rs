//! The page of a trial: what was asked of the diagnosis and what came, and where it goes wrong.

use std::collections::{BTreeMap, BTreeSet};

use askama::Template;
use towmag_trial::{Figure, OnScore, Rate, Score, State, Trial, figures, on_figures};

use super::chart::{self, Chart, Series};
use super::frame::{PageFrame, plotly_js};
use crate::effects::{Library, Spec};
use crate::text::diagnosis as words;

/// Recordings below which most figures stay open.
const FEW: usize = 200;

/// `trial` as one self-contained HTML page.
///
/// # Errors
///
/// When the template cannot be filled; what it is filled with has no way to fail today.
pub fn render_trial(trial: &Trial) -> std::io::Result<String> {
    let figures = match (&trial.score, &trial.on) {
        (Some(score), _) => figures(score),
        (None, Some(on)) => on_figures(on),
        (None, None) => Vec::new(),
    };
    let facts = facts(trial);
    let warnings = warnings(trial);
    let name = recording(trial);
    let page = Page {
        frame: PageFrame {
            title: "Blind trial of the diagnosis",
            kind: "Blind trial",
            recording: &name,
            headline: headline(trial, &figures).into(),
            warnings: &warnings,
            facts: &facts,
            plotly_js: plotly_js(),
        },
        figures,
        strengths: strengths(trial),
        is_on: trial.on.is_some(),
        reliability: trial.score.as_ref().map(|score| chart::reliability(&score.calibration.bins)),
        in_set_colour: chart::IN_SET,
        named_colour: chart::NAMED,
        matrix: trial.score.as_ref().map(matrix),
        mistakes: trial.score.as_ref().map(mistakes).unwrap_or_default(),
        tables: [
            ("Taken out of the library, and put back", trial.score.as_ref().map(withheld).unwrap_or_default()),
            ("False alarms, by noise and motion", trial.score.as_ref().map(alarms).unwrap_or_default()),
            ("Intervals that hold the truth, by effect", trial.score.as_ref().map(intervals).unwrap_or_default()),
        ],
        untouched: trial.on.as_ref().map(|on| on.untouched.clone()),
        missed: trial.on.as_ref().map(|on| on.missed.clone()).unwrap_or_default(),
    };
    page.render().map_err(std::io::Error::other)
}

#[derive(Template)]
#[template(path = "trial.html")]
struct Page<'a> {
    frame: PageFrame<'a>,
    figures: Vec<Figure>,
    strengths: Chart,
    is_on: bool,
    reliability: Option<Chart>,
    in_set_colour: &'static str,
    named_colour: &'static str,
    matrix: Option<Matrix>,
    mistakes: Vec<Mistake>,
    /// Title and lines, each a label and a value.
    tables: [(&'static str, Vec<(String, String)>); 3],
    untouched: Option<String>,
    missed: Vec<String>,
}

/// What was hidden against what was said.
struct Matrix {
    said: Vec<String>,
    rows: Vec<MatrixRow>,
}

struct MatrixRow {
    hidden: String,
    of: usize,
    cells: Vec<MatrixCell>,
}

struct MatrixCell {
    count: usize,
    /// Of the row, percent.
    shade: usize,
    is_right: bool,
}

/// An answer that was not right.
struct Mistake {
    hidden: String,
    said: String,
}

fn recording(trial: &Trial) -> String {
    match &trial.options.on {
        Some(path) => path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        None => format!("{} recordings", trial.options.recordings),
    }
}

fn headline(trial: &Trial, figures: &[Figure]) -> String {
    if let Some(on) = &trial.on {
        let Rate { hits, of, .. } = on.named_from_3;
        return format!("Of {of} effects of strength 3 and more that were put into the recording, {hits} are named.");
    }
    let count = |state: State| figures.iter().filter(|figure| figure.state == state).count();
    let counted = figures.len() - count(State::None);
    let mut text =
        format!("The diagnosis reaches {} of the {counted} figures that it is held to", count(State::Reached));
    match (count(State::Missed), count(State::Open)) {
        (0, 0) => {}
        (0, open) => text += &format!("; {open} are open: so few recordings cannot tell"),
        (missed, 0) => text += &format!("; {missed} are missed"),
        (missed, open) => text += &format!("; {missed} are missed, {open} are open: so few recordings cannot tell"),
    }
    text + "."
}

fn warnings(trial: &Trial) -> Vec<String> {
    let few = trial.on.is_none() && trial.options.recordings < FEW;
    let text =
        format!("Only {} recordings: the intervals are wide. A full trial has 400 or more.", trial.options.recordings);
    few.then_some(text).into_iter().collect()
}

fn facts(trial: &Trial) -> Vec<(String, String)> {
    let options = &trial.options;
    let fact = |label: &str, value: String| (label.to_string(), value);
    let mut facts = vec![fact("Recordings", trial.results.len().to_string())];
    if let Some(OnScore { scalar_residual_rms_nt, fluxgate_residual_rms_nt, .. }) = &trial.on {
        facts.push(fact("Residual of the scalar", format!("{scalar_residual_rms_nt:.3} nT rms")));
        facts.push(fact("Residual of the fluxgate", format!("{fluxgate_residual_rms_nt:.3} nT rms")));
    } else {
        facts.push(fact(
            "Length of each",
            options.minutes.map_or("2 to 60 min".into(), |minutes| format!("{minutes} min")),
        ));
        facts.push(fact("Set in", options.setting.to_string()));
    }
    facts.extend(options.withhold.iter().map(|name| fact("Taken out of the library", words::label(&specs(), name))));
    facts.push(fact("Seed", options.seed.to_string()));
    facts.push(fact("SHA-256 of the answers, told before", trial.answers_sha256.clone()));
    facts.push(fact("Program", format!("host-sim {}", env!("CARGO_PKG_VERSION"))));
    facts
}

fn strengths(trial: &Trial) -> Chart {
    let series = |name, colour, rates| Series { name, colour, rates };
    if let Some(on) = &trial.on {
        let named = on.named.iter().map(|bin| (bin.strength, bin.named)).collect();
        return chart::strengths(&[series("newly named", chart::IN_SET, named)]);
    }
    let bins = trial.score.iter().flat_map(|score| &score.singles);
    let in_set = bins.clone().map(|bin| (bin.strength, bin.right_or_in_set)).collect();
    let alone = bins.map(|bin| (bin.strength, bin.alone_right)).collect();
    chart::strengths(&[
        series("right, or in the stated set", chart::IN_SET, in_set),
        series("named alone", chart::NAMED, alone),
    ])
}

/// An answer in a word: pairs have no row of their own, and several names are one column.
fn column(said: &str) -> String {
    let named: Vec<&str> = said.split(" + ").filter(|name| *name != "unknown").collect();
    match named[..] {
        [] => "unknown".into(),
        [name] => name.into(),
        _ => "several".into(),
    }
}

fn matrix(score: &Score) -> Matrix {
    let rows: Vec<(&String, &BTreeMap<String, usize>)> =
        score.confusion.iter().filter(|(hidden, _)| !hidden.contains(" + ")).collect();
    let found: BTreeSet<String> = rows.iter().flat_map(|(_, said)| said.keys().map(|said| column(said))).collect();
    // Those of effects first, in the order of the rows.
    let last = ["none", "unknown", "several"];
    let mut said: Vec<String> = found.iter().filter(|name| !last.contains(&name.as_str())).cloned().collect();
    said.extend(last.iter().filter(|name| found.contains(**name)).map(|name| name.to_string()));
    let row = |(hidden, answers): &(&String, &BTreeMap<String, usize>)| {
        let of: usize = answers.values().sum();
        let right = right_answer(hidden);
        let cell = |name: &String| {
            let own = answers.iter().filter(|(answer, _)| column(answer) == *name);
            let count = own.map(|(_, count)| count).sum();
            MatrixCell { count, shade: 100 * count / of.max(1), is_right: *name == right }
        };
        MatrixRow { hidden: name_of(hidden), of, cells: said.iter().map(cell).collect() }
    };
    let rows = rows.iter().map(row).collect();
    Matrix { rows, said: said.iter().map(|name| name_of(name)).collect() }
}

/// What ought to be said.
fn right_answer(hidden: &str) -> String {
    let is_known = |name: &str| name == "none" || words::spec(&specs(), name).is_some();
    if hidden.split(" + ").all(is_known) { hidden.into() } else { "unknown".into() }
}

fn mistakes(score: &Score) -> Vec<Mistake> {
    let mut all = Vec::new();
    for (hidden, answers) in &score.confusion {
        let right = right_answer(hidden);
        for (said, count) in answers.iter().filter(|(said, _)| **said != right) {
            let times = if *count > 1 { format!(" ({count} times)") } else { String::new() };
            all.push(Mistake { hidden: names(hidden), said: names(said) + &times });
        }
    }
    all
}

fn names(joined: &str) -> String {
    joined.split(" + ").map(name_of).collect::<Vec<String>>().join(" + ")
}

/// As it is written in every file: what a reader searches for.
fn name_of(name: &str) -> String {
    match name {
        "none" => "no gap".into(),
        other => other.replace('_', " "),
    }
}

fn alarms(score: &Score) -> Vec<(String, String)> {
    let groups = [("Noise", &score.false_alarms_by_noise), ("Motion", &score.false_alarms_by_motion)];
    let row = |group: &str, name: &str, rate: &Rate| (format!("{group}: {name}"), counted(rate));
    groups.iter().flat_map(|(group, rates)| rates.iter().map(move |(name, rate)| row(group, name, rate))).collect()
}

/// Of the parameters and of the shrink, each effect by itself.
fn intervals(score: &Score) -> Vec<(String, String)> {
    let row = |(name, parameters): (&String, &Rate)| {
        let shrink = score
            .shrink
            .cover_by_effect
            .get(name)
            .map_or_else(String::new, |rate| format!("; shrink {} of {}", rate.hits, rate.of));
        (name_of(name), format!("parameters {} of {}{shrink}", parameters.hits, parameters.of))
    };
    score.intervals_cover_by_effect.iter().map(row).collect()
}

fn withheld(score: &Score) -> Vec<(String, String)> {
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

/// What is written about the effects of this program.
fn specs() -> Vec<&'static Spec> {
    Library::default().specs().collect()
}
