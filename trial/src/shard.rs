//! A part of a trial: the recordings that one of several jobs takes.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::error::TrialError;

/// Part `number` of `of`, from 1. Every `of`th recording is in it: neighbours are alike in nothing, so parts take about as
/// long as one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// Part `number` of `of`.
    ///
    /// # Errors
    ///
    /// When there is no such part.
    pub fn new(number: usize, of: usize) -> Result<Self, TrialError> {
        match (1..=of).contains(&number) {
            true => Ok(Self { number, of }),
            false => Err(TrialError::Shard(format!("{number}/{of}"))),
        }
    }

    /// Which part, from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// How many parts the trial has.
    pub fn of(self) -> usize {
        self.of
    }

    /// How many of so many recordings are in it.
    pub(crate) fn count(self, recordings: usize) -> usize {
        (self.number - 1..recordings).step_by(self.of).len()
    }

    /// Whether the recording with this number, from 0, is in it.
    pub fn takes(self, index: usize) -> bool {
        index % self.of == self.number - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = TrialError;

    fn from_str(text: &str) -> Result<Self, TrialError> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        let (number, of) = numbers.ok_or_else(|| TrialError::Shard(text.into()))?;
        Self::new(number, of)
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = TrialError;

    fn try_from(text: String) -> Result<Self, TrialError> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_recording_is_in_one_part() {
        for of in 1..6 {
            let parts: Vec<Shard> = (1..=of).map(|number| Shard::new(number, of).unwrap()).collect();
            assert!((0..20).all(|index| parts.iter().filter(|part| part.takes(index)).count() == 1));
        }
    }

    #[test]
    fn what_is_no_part_is_refused() {
        assert_eq!("2/3".parse::<Shard>().unwrap().to_string(), "2/3");
        for text in ["", "2", "0/3", "4/3", "1/0", "a/b", "1/2/3", "-1/3"] {
            let error = text.parse::<Shard>().unwrap_err();
            assert!(error.is_bad_input() && error.to_string().contains("choose"), "{text}: {error}");
        }
    }
}
