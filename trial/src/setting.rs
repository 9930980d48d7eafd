//! Where a trial is set: in the world that a diagnosis is tuned in, or in the one that judges it.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::error::TrialError;

/// What mechanisms outside the library, motions, bodies and noise there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// Few, which whoever works on a diagnosis may look at.
    Tuning,
    /// Many, none of whose mechanisms is among those of tuning.
    Trial,
}

impl Setting {
    fn name(self) -> &'static str {
        match self {
            Self::Tuning => "tuning",
            Self::Trial => "trial",
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Setting {
    type Err = TrialError;

    fn from_str(text: &str) -> Result<Self, TrialError> {
        let is_named = |setting: &Self| setting.name() == text;
        [Self::Tuning, Self::Trial].into_iter().find(is_named).ok_or_else(|| TrialError::Setting(text.into()))
    }
}
