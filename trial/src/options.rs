//! What a trial is asked for.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::answer::Kind;
use crate::error::TrialError;
use crate::limits::{LEAST_MINUTES, MOST_MINUTES};
use crate::own_effect::OwnEffect;
use crate::recorder::RecorderKind;
use crate::setting::Setting;
use crate::shard::Shard;
use crate::world::effects::Effect;

/// What a trial is asked for.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct TrialOptions {
    /// How many recordings.
    pub recordings: usize,
    /// Seed of everything.
    pub seed: u64,
    /// Length of each recording, minutes; drawn for each where this is not said: mostly 2 to 12, up to 60.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minutes: Option<f64>,
    /// Where it is set.
    pub setting: Setting,
    /// What every recording hides; any kind in its share where this is not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only: Option<Kind>,
    /// The effect that is taken out of the library; all single effects are then this one.
    pub withhold: Option<String>,
    /// Whether each recording comes with a simulation of its track, at another rate and by another clock.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub simulated: bool,
    /// Effects that a user wrote: all single effects are then one of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own: Vec<OwnEffect>,
    /// How the recorders round; each recording has any of the kinds where this is not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recorder: Option<RecorderKind>,
    /// Whether the recordings hold targets; two of three do where this is not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets: Option<bool>,
    /// Whether the body heaves and turns as it passes targets, instead of passing each on a straight line at one depth.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub rough_passes: bool,
    /// A recording that effects are put into, instead of recordings that are made.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<PathBuf>,
    /// Whether the first bad row of that recording is the end, instead of being left out.
    #[serde(skip)]
    pub strict: bool,
    /// The part of it that is to be tried; all where this is not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// Whether the recordings stay, as `recordings/000.csv` and so on.
    pub keep: bool,
}

impl Default for TrialOptions {
    fn default() -> Self {
        Self {
            recordings: 60,
            seed: 1,
            minutes: None,
            setting: Setting::Trial,
            only: None,
            withhold: None,
            simulated: false,
            own: Vec::new(),
            recorder: None,
            targets: None,
            rough_passes: false,
            on: None,
            strict: false,
            shard: None,
            keep: false,
        }
    }
}

impl TrialOptions {
    /// What the effects do that users wrote.
    pub(crate) fn own_effects(&self) -> Vec<&'static Effect> {
        self.own.iter().filter_map(OwnEffect::effect).collect()
    }

    /// The numbers of the recordings that are tried.
    pub(crate) fn indices(&self) -> Vec<usize> {
        (0..self.recordings).filter(|&index| self.shard.is_none_or(|shard| shard.takes(index))).collect()
    }

    /// How many recordings are tried at most.
    pub fn recordings_tried(&self) -> usize {
        self.indices().len()
    }

    /// Refuse what cannot be tried.
    ///
    /// # Errors
    ///
    /// Without a recording, or one for each part, and outside 2 to 120 minutes.
    pub fn check(&self) -> Result<(), TrialError> {
        if self.recordings == 0 {
            return Err(TrialError::Recordings(self.recordings));
        }
        if let Some(shard) = self.shard.filter(|shard| shard.of() > self.recordings) {
            return Err(TrialError::Shards { shard: shard.to_string(), recordings: self.recordings });
        }
        match self.minutes {
            Some(minutes) if !(LEAST_MINUTES..=MOST_MINUTES).contains(&minutes) => Err(TrialError::Minutes(minutes)),
            _ => Ok(()),
        }
    }
}
