//! What a trial came to: `trial.json`.

use serde::Serialize;

use crate::error::TrialError;
use crate::options::TrialOptions;
use crate::reply::{Reply, TrialResult};
use crate::score::{OnScore, Score, on_score, score};
use crate::seal::Sealed;

/// What a trial came to: `trial.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// Format.
    pub schema: u32,
    /// What was asked for.
    pub options: TrialOptions,
    /// Of the program; only of a part, which must be merged with those of the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
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

/// A real recording that effects were put into: the residual that strengths are relative to, of the scalar and of the
/// fluxgate, and what was said of it untouched.
pub(crate) type Untouched = ([f64; 2], Reply);

impl Trial {
    /// What can be told while the answers are sealed.
    pub(crate) fn unopened(options: &TrialOptions, sealed: &Sealed) -> Self {
        Self {
            schema: 1,
            options: options.clone(),
            version: options.shard.map(|_| env!("CARGO_PKG_VERSION").into()),
            answers_sha256: sealed.sha256.clone(),
            score: None,
            on: None,
            untouched: None,
            results: Vec::new(),
        }
    }

    /// The answers opened, and what was said scored.
    pub(crate) fn opened(
        options: &TrialOptions,
        sealed: &Sealed,
        untouched: Option<Untouched>,
        results: Vec<TrialResult>,
    ) -> Result<Self, TrialError> {
        let answers = sealed.open()?;
        let mut trial = Self::unopened(options, sealed);
        match &untouched {
            Some((residual_rms_nt, said)) => {
                trial.on = Some(on_score(*residual_rms_nt, &answers, said.said(), &results));
            }
            None => trial.score = Some(score(&answers, &results, options.withhold.as_deref())),
        }
        Ok(Self { untouched: untouched.map(|(_, said)| said), results, ..trial })
    }
}
