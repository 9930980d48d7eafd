//! The page of a trial: what was asked of the diagnosis and what came, and where it goes wrong.

mod confusion;
mod tables;

use askama::Template;
use towmag_trial::{Figure, OnScore, Rate, State, Trial, figures, on_figures};

use confusion::{Matrix, Mistake, matrix, mistakes, specs};
use tables::{alarms, intervals, withheld};

use super::chart::{self, Chart, Series};
use super::frame::{PageFrame, plotly_js};
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
            headline_class: "",
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
