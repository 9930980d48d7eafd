//! What a recording of a trial hides.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::error::TrialError;

/// What is hidden in a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing.
    None,
    /// One effect of the library.
    Single,
    /// Two, about equally strong.
    Pair,
    /// Two, one ten times as strong as the other.
    UnequalPair,
    /// Three.
    Triple,
    /// A mechanism that the library does not have.
    Foreign,
}

impl FromStr for Kind {
    type Err = TrialError;

    fn from_str(text: &str) -> Result<Self, TrialError> {
        Ok(match text {
            "none" => Self::None,
            "single" => Self::Single,
            "pair" => Self::Pair,
            "unequal_pair" => Self::UnequalPair,
            "triple" => Self::Triple,
            "foreign" => Self::Foreign,
            other => return Err(TrialError::Kind(other.into())),
        })
    }
}

impl Kind {
    /// How many effects of the library it hides.
    pub fn effects(self) -> usize {
        match self {
            Self::None | Self::Foreign => 0,
            Self::Single => 1,
            Self::Pair | Self::UnequalPair => 2,
            Self::Triple => 3,
        }
    }
}

/// The answer to one recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Number of the recording, from 0.
    pub index: usize,
    /// What is hidden.
    pub kind: Kind,
    /// How long it is.
    pub minutes: f64,
    /// `land`, `lake`, `sea`, `jerky` or `flight`.
    pub motion: String,
    /// Colour of the scalar's noise, and whether its tails are heavy.
    pub noise: String,
    /// Its rms from 0.04 to 5 Hz, nT.
    #[serde(rename = "noise_rms_nT")]
    pub noise_rms_nt: f64,
    /// Rms of the noise of each fluxgate component, nT.
    #[serde(rename = "fluxgate_noise_rms_nT")]
    pub fluxgate_noise_rms_nt: f64,
    /// How the recorder rounds: `fine`, `ordinary` or `padded`.
    pub recorder: String,
    /// Worlds that were drawn for this recording before the one that it is from.
    pub world: u32,
    /// The effects or the mechanism.
    pub hidden: Vec<Hidden>,
    /// Recorded inputs that drive what is hidden, where it is one thing: any of them is right, and none of an empty list.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drivers: Vec<String>,
    /// Whether a part of it is chance, which no shape of a driver can follow.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_random: bool,
    /// The iron that the body passes, in the order of time: signal, whatever else is hidden.
    pub targets: Vec<Target>,
}

/// A target: a dipole that the body passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// When its anomaly is largest, on the time axis of the recording, s.
    pub time_s: f64,
    /// That largest anomaly of the total field, nT, with its sign.
    #[serde(rename = "peak_nT")]
    pub peak_nt: f64,
    /// Between the half heights of its largest lobe, s.
    pub width_s: f64,
}

/// One effect or mechanism.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Its name.
    pub name: String,
    /// The load whose recorded current drives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<String>,
    /// By name, in the unit of the name; of a mechanism outside the library its size.
    pub parameters: BTreeMap<String, f64>,
    /// Its rms over that of the noise, both from 0.04 to 5 Hz.
    pub strength: f64,
    /// Root of twice the log likelihood ratio that it could be found with, were all but its presence known: what the
    /// 18 terms and the slow background do not take, over the noise.
    pub identifiable: f64,
}
