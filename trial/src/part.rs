//! What one of several jobs has left of a trial.

use serde::Deserialize;

use crate::answer::Answer;
use crate::error::TrialError;
use crate::options::TrialOptions;
use crate::reply::{Reply, TrialResult};
use crate::seal::seal;
use crate::shard::Shard;

/// The `answers.json` and the `trial.json` of one job, which fit one another.
#[derive(Clone, Debug)]
pub struct Part {
    pub(crate) name: String,
    pub(crate) shard: Shard,
    pub(crate) answers: Vec<Answer>,
    pub(crate) file: PartFile,
}

/// What is read of a part's `trial.json`.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct PartFile {
    pub(crate) options: TrialOptions,
    #[serde(default)]
    pub(crate) version: Option<String>,
    answers_sha256: String,
    score: Option<serde::de::IgnoredAny>,
    pub(crate) on: Option<OnResidual>,
    pub(crate) untouched: Option<Reply>,
    pub(crate) results: Vec<TrialResult>,
}

/// What the score of a trial on a recording needs of that recording.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub(crate) struct OnResidual {
    #[serde(rename = "scalar_residual_rms_nT")]
    pub(crate) scalar_nt: f64,
    #[serde(rename = "fluxgate_residual_rms_nT")]
    pub(crate) fluxgate_nt: f64,
}

impl Part {
    /// Read the two files of a part; errors call it `name`.
    ///
    /// # Errors
    ///
    /// When they are none, are of a trial without parts, are not finished, or do not fit one another.
    pub fn read(name: &str, answers: &str, trial: &str) -> Result<Self, TrialError> {
        let wrong = |what: String| TrialError::Part { name: name.into(), what };
        let unread = |file: &str, error: serde_json::Error| wrong(format!("{file} cannot be read: {error}"));
        let file: PartFile = serde_json::from_str(trial).map_err(|error| unread("trial.json", error))?;
        let parsed: Vec<Answer> = serde_json::from_str(answers).map_err(|error| unread("answers.json", error))?;
        let shard = file.options.shard.ok_or_else(|| wrong("is a whole trial, run without --shard".into()))?;
        if file.score.is_none() && file.on.is_none() {
            return Err(wrong(format!("is not finished: run it again, with --shard {shard}")));
        }
        if seal(answers) != file.answers_sha256 {
            return Err(wrong(format!(
                "the answers are not those that were sealed: run it again, with --shard {shard}"
            )));
        }
        let part = Self { name: name.into(), shard, answers: parsed, file };
        match part.is_whole() {
            true => Ok(part),
            false => Err(wrong(format!("results and answers do not fit: run it again, with --shard {shard}"))),
        }
    }

    /// Which part it is.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// What was asked for, were it not in parts.
    pub fn options(&self) -> TrialOptions {
        TrialOptions { shard: None, ..self.file.options.clone() }
    }

    /// Whether every recording of the part has one answer and one result. Into a real recording fewer effects may have been
    /// put than were asked for.
    fn is_whole(&self) -> bool {
        let mut taken = (0..self.file.options.recordings).filter(|&index| self.shard.takes(index));
        let are_in_order = self.answers.iter().all(|answer| taken.any(|index| index == answer.index));
        let are_all = self.file.on.is_some() || self.answers.len() == self.shard.count(self.file.options.recordings);
        are_in_order && are_all && self.answers.len() == self.file.results.len()
    }
}
