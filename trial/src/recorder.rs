//! How a recorder rounds what the sensors say, and how many digits it writes.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::error::TrialError;

/// A way to round and to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecorderKind {
    /// Steps far below the noise, all digits true.
    Fine,
    /// Steps that add up to 2 % to the noise power, all digits true.
    Ordinary,
    /// The same or those of a 16-bit converter, written with more digits than they have.
    Padded,
}

impl RecorderKind {
    /// Every kind, in the order in which they are drawn.
    pub(crate) const ALL: [Self; 3] = [Self::Fine, Self::Ordinary, Self::Padded];

    fn name(self) -> &'static str {
        match self {
            Self::Fine => "fine",
            Self::Ordinary => "ordinary",
            Self::Padded => "padded",
        }
    }
}

impl fmt::Display for RecorderKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for RecorderKind {
    type Err = TrialError;

    fn from_str(text: &str) -> Result<Self, TrialError> {
        let is_named = |kind: &Self| kind.name() == text;
        Self::ALL.into_iter().find(is_named).ok_or_else(|| TrialError::Recorder(text.into()))
    }
}
