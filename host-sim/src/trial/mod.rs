//! A blind trial of the diagnosis: recordings with hidden effects, answers sealed before it begins, opened after it.
//!
//! ```text
//! draw -> answers.json, its SHA-256 told -> diagnose every recording without it -> open, check the hash -> score
//! ```

mod answer;
mod draw;
mod identifiable;
mod on;
mod score;
mod size;
mod slow;
pub mod terminal;
mod world;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::diagnosis::{DiagnoseSettings, Diagnosis, Table, diagnose};
use crate::error::HostError;
use crate::recording::{self, CsvReader};

pub use answer::{Answer, Hidden, Kind};
pub use on::{OnBin, OnScore};
pub use score::{
    Bin, Calibration, Figure, PairBin, Promise, Rate, Score, Shrink, State, WithheldScore, figures, on_figure,
};

/// What a trial is asked for.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct TrialOptions {
    /// How many recordings.
    pub recordings: usize,
    /// Seed of everything.
    pub seed: u64,
    /// Length of each recording, minutes.
    pub minutes: f64,
    /// The effect that is taken out of the library; all single effects are then this one.
    pub withhold: Option<String>,
    /// A recording that effects are put into, instead of recordings that are made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<PathBuf>,
    /// Whether the recordings stay, as `recordings/000.csv` and so on.
    pub keep: bool,
}

/// What a trial came to: `trial.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// Format.
    pub schema: u32,
    /// What was asked for.
    pub options: TrialOptions,
    /// SHA-256 of `answers.json`, hexadecimal, known before the first diagnosis.
    pub answers_sha256: String,
    /// The score; none while the answers are sealed, or of a trial on a recording.
    pub score: Option<Score>,
    /// The score of a trial on a recording.
    pub on: Option<OnScore>,
    /// What was said of that recording, untouched.
    pub untouched: Option<Diagnosis>,
    /// One entry a recording; empty while the answers are sealed.
    pub results: Vec<Said>,
}

/// What was said of a recording.
#[derive(Clone, Debug, Serialize)]
pub struct Said {
    /// Without the withheld effect, or with all.
    pub diagnosis: Diagnosis,
    /// With the withheld effect back in the library; of recordings that have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub put_back: Option<Diagnosis>,
}

/// The answers, as text, and the seal on them.
#[derive(Clone, Debug)]
pub struct Sealed {
    /// What `answers.json` holds.
    pub answers: String,
    /// SHA-256 of it, hexadecimal.
    pub sha256: String,
}

/// Draw the answers; with a recording, of effects that are put into it.
pub fn draw(options: &TrialOptions, on: Option<&Table>) -> Sealed {
    match on {
        Some(table) => on::draw(options, table),
        None => made(options),
    }
}

fn made(options: &TrialOptions) -> Sealed {
    let all = bar(options.recordings, "drawing");
    let one = |index| {
        let answer = draw::answer(options, index);
        all.inc(1);
        answer
    };
    let drawn: Vec<Answer> = (0..options.recordings).into_par_iter().map(one).collect();
    all.finish_and_clear();
    Sealed::of(&drawn)
}

/// Every recording of a trial as CSV: number and text go to `keep`.
///
/// # Errors
///
/// Those of `keep`.
pub fn recordings(
    options: &TrialOptions,
    on: Option<&Table>,
    sealed: &Sealed,
    keep: impl Fn(usize, &str) -> Result<(), HostError> + Sync,
) -> Result<(), HostError> {
    let text = |answer: &Answer| match on {
        Some(table) => on::csv(&on::injected(options, table, answer)),
        None => draw::recording(options, answer),
    };
    open(sealed)?.par_iter().try_for_each(|answer| keep(answer.index, &text(answer)))
}

impl Sealed {
    fn of(answers: &[Answer]) -> Self {
        let answers = crate::summary::to_json(&answers);
        Self { sha256: seal(&answers), answers }
    }
}

/// SHA-256 of a text, hexadecimal.
pub fn seal(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Diagnose every recording of a trial; of a trial on a recording, that one first.
///
/// # Errors
///
/// When a recording is too short for a diagnosis.
pub fn diagnose_all(
    options: &TrialOptions,
    on: Option<&Table>,
    sealed: &Sealed,
    trial: &mut Trial,
) -> Result<(), HostError> {
    if let Some(table) = on {
        let (untouched, results) = on::diagnose_all(options, table, sealed)?;
        (trial.untouched, trial.results) = (Some(untouched), results);
        return Ok(());
    }
    let answers = open(sealed)?;
    let all = bar(answers.len(), "diagnosing");
    let said: Result<Vec<Said>, HostError> =
        answers.par_iter().map(|answer| said(options, answer).inspect(|_| all.inc(1))).collect();
    all.finish_and_clear();
    trial.results = said?;
    Ok(())
}

/// Open the answers and score what was said.
///
/// # Errors
///
/// When the answers are not those that were sealed.
pub fn score(options: &TrialOptions, on: Option<&Table>, sealed: &Sealed, trial: &mut Trial) -> Result<(), HostError> {
    match (on, &trial.untouched) {
        (Some(table), Some(untouched)) => trial.on = Some(on::score(table, sealed, untouched, &trial.results)?),
        _ => trial.score = Some(score::of(&open(sealed)?, &trial.results, options.withhold.as_deref())),
    }
    Ok(())
}

fn open(sealed: &Sealed) -> Result<Vec<Answer>, HostError> {
    if seal(&sealed.answers) != sealed.sha256 {
        return Err(HostError::NotEnough("the answers are not those that were sealed".into()));
    }
    serde_json::from_str(&sealed.answers).map_err(|error| HostError::NotEnough(format!("the answers: {error}")))
}

/// The recording is made here and forgotten: only its rows reach the diagnosis.
fn said(options: &TrialOptions, answer: &Answer) -> Result<Said, HostError> {
    let read = |csv: String| -> Result<Table, HostError> {
        let mut reader = CsvReader::from_reader(format!("recording {}", answer.index), csv.as_bytes())?;
        Ok(Table::of(&recording::Table::read(&mut reader)?))
    };
    let table = read(draw::recording(options, answer))?;
    // A second recording shows how far the gap really shrinks: where a single effect is right, whatever the first says.
    let second = match answer.kind {
        Kind::Single => Some(read(draw::other_recording(options, answer))?),
        _ => None,
    };
    let settings = |withheld: &Option<String>| DiagnoseSettings {
        withheld: withheld.iter().cloned().collect(),
        seed: options.seed,
        coefficients: None,
    };
    let diagnosis = slim(diagnose(&table, second.as_ref(), &settings(&options.withhold))?);
    let has = |name: &String| answer.hidden.iter().any(|hidden| hidden.name == *name);
    let put_back = match options.withhold.as_ref().is_some_and(has) {
        true => Some(slim(diagnose(&table, None, &settings(&None))?)),
        false => None,
    };
    Ok(Said { diagnosis, put_back })
}

/// Without what only a page needs.
fn slim(diagnosis: Diagnosis) -> Diagnosis {
    Diagnosis { pictures: Vec::new(), ..diagnosis }
}

fn bar(len: usize, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix} [{bar:40}] {pos} of {len}, {eta} left");
    let bar = ProgressBar::new(len as u64).with_style(style.expect("a constant template").progress_chars("=> "));
    bar.set_prefix(what);
    bar
}
