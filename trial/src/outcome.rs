//! What a trial came to: `trial.json`.

use serde::Serialize;

use crate::options::TrialOptions;
use crate::reply::{Reply, TrialResult};
use crate::score::{OnScore, Score};

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
    pub untouched: Option<Reply>,
    /// One entry a recording; empty while the answers are sealed.
    pub results: Vec<TrialResult>,
}
