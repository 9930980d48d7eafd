//! What can go wrong in a trial.

use crate::limits::{LEAST_MINUTES, LEAST_VALID_S, MOST_MINUTES};

/// Why a trial cannot be held, or not be scored. Its display is one line.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// A trial of nothing.
    #[error("recordings {0}: choose at least 1")]
    Recordings(usize),
    /// Recordings that are too short to hide anything, or too long.
    #[error("minutes {0}: choose {LEAST_MINUTES} to {MOST_MINUTES}")]
    Minutes(f64),
    /// An effect that a user wrote cannot be tried.
    #[error("{0}")]
    OwnEffect(String),
    /// No kind of recorder has this name.
    #[error("recorder {0}: choose fine, ordinary or padded")]
    Recorder(String),
    /// No setting has this name.
    #[error("setting {0}: choose tuning or trial")]
    Setting(String),
    /// No kind has this name.
    #[error("only {0}: choose none, single, pair, unequal_pair, triple or foreign")]
    Kind(String),
    /// No part has this name.
    #[error("shard {0}: choose K/N, part K of N, from 1/N to N/N")]
    Shard(String),
    /// More parts than recordings.
    #[error("shard {shard}: there are only {recordings} recordings; choose no more parts than that")]
    Shards {
        /// The part that was asked for.
        shard: String,
        /// Of the whole trial.
        recordings: usize,
    },
    /// It cannot be merged with the others.
    #[error("{name}: {what}")]
    Part {
        /// Name of the part.
        name: String,
        /// What is wrong with it, and what to do.
        what: String,
    },
    /// Some parts of the trial are not there.
    #[error("{} of {of} missing: run it with the same options and --shard {}/{of}, and name its folder too", shown(missing), missing.first().unwrap_or(&1))]
    MissingParts {
        /// Their numbers, from 1.
        missing: Vec<usize>,
        /// How many parts the trial has.
        of: usize,
    },
    /// Nothing to merge.
    #[error("no part of a trial: name the folders that `trial --shard` has written")]
    NoParts,
    /// The recording that effects shall be put into is no CSV.
    #[error("{name}: {source}")]
    Csv {
        /// Name of the recording.
        name: String,
        /// The parser's own words.
        source: csv::Error,
    },
    /// It lacks a column.
    #[error("{name}: the column {column} is missing")]
    MissingColumn {
        /// Name of the recording.
        name: String,
        /// The column.
        column: &'static str,
    },
    /// It is too short.
    #[error("{name}: {valid_s:.1} s of valid rows, a trial needs at least {LEAST_VALID_S:.0} s")]
    TooShort {
        /// Name of the recording.
        name: String,
        /// What it has, s.
        valid_s: f64,
    },
    /// None of the effects that may be put into it is one that the trial has a model of.
    #[error("{name}: no effect to put in")]
    NothingToPutIn {
        /// Name of the recording.
        name: String,
    },
    /// Somebody changed the answers.
    #[error("the answers are not those that were sealed")]
    SealBroken,
    /// The answers cannot be read back.
    #[error("the answers: {0}")]
    Answers(serde_json::Error),
    /// What came back is no `diagnosis.json`.
    #[error("{name}: its diagnosis.json cannot be read: {source}")]
    Reply {
        /// Name of the recording.
        name: String,
        /// The parser's own words.
        source: serde_json::Error,
    },
}

/// The first few numbers, and how many more.
fn shown(numbers: &[usize]) -> String {
    let first: Vec<String> = numbers.iter().take(8).map(usize::to_string).collect();
    let (are, more) = (if numbers.len() == 1 { "part" } else { "parts" }, numbers.len() - first.len());
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{are} {}{rest}", first.join(", "))
}

impl TrialError {
    /// Whether options or the recording are to blame, and not the work.
    pub fn is_bad_input(&self) -> bool {
        !matches!(self, Self::SealBroken | Self::Answers(_) | Self::Reply { .. })
    }
}
