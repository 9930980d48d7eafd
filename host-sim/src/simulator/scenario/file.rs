//! The scenario file as a whole.

use std::path::Path;

use serde::Deserialize;

use super::body::{Current, FlaggedZone, InterferenceSource, SecondScalar, Sensor, Temperature};
use super::dipole::DipoleSpec;
use super::field::{Background, Bottom, Field};
use super::motion::Motion;
use super::rows::{Columns, Interval, Ship, TargetSpec};
use crate::error::HostError;

/// A whole scenario.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What it is, for the reader.
    #[serde(default)]
    pub title: String,
    /// Seed of everything random, where the command line gives none.
    #[serde(default = "one")]
    pub seed: u64,
    /// Length of the recording, s.
    pub duration_s: f64,
    /// Time of the first row on the recording's own axis, s.
    #[serde(default)]
    pub first_time_s: f64,
    /// The Earth's field.
    pub field: Field,
    /// What changes it slowly.
    #[serde(default)]
    pub background: Background,
    /// How the body moves.
    pub motion: Motion,
    /// What the body adds to the field.
    pub interference: InterferenceSource,
    /// The scalar sensor.
    pub scalar: Sensor,
    /// The fluxgate.
    pub fluxgate: Sensor,
    /// A second scalar sensor: column `scalar2_nT`.
    pub scalar2: Option<SecondScalar>,
    /// Where the scalar sensor flags its readings as invalid.
    pub dead_zone: Option<FlaggedZone>,
    /// Temperature at the fluxgate.
    pub temperature: Option<Temperature>,
    /// Loads whose current is recorded.
    #[serde(default, rename = "current")]
    pub currents: Vec<Current>,
    /// What a survey is for.
    #[serde(default, rename = "target")]
    pub targets: Vec<TargetSpec>,
    /// Iron that is passed, as physics has it.
    #[serde(default, rename = "dipole")]
    pub dipoles: Vec<DipoleSpec>,
    /// The bottom of the water, or the ground.
    pub bottom: Option<Bottom>,
    /// The ship ahead, whose position is recorded in place of the body's.
    pub ship: Option<Ship>,
    /// Times whose rows are missing.
    #[serde(default, rename = "gap")]
    pub gaps: Vec<Interval>,
    /// Times in which the scalar sensor flags its readings as invalid.
    #[serde(default, rename = "dropout")]
    pub dropouts: Vec<Interval>,
    /// Which optional columns are written.
    #[serde(default)]
    pub columns: Columns,
}

fn one() -> u64 {
    1
}

impl Scenario {
    /// Read and check a file.
    pub fn read(path: &Path) -> Result<Self, HostError> {
        let file = path.display();
        let text = std::fs::read_to_string(path)
            .map_err(|error| HostError::Usage(format!("{file}: cannot be read: {error}")))?;
        Self::parse(&text).map_err(|what| HostError::Usage(format!("{file}: {what}")))
    }

    /// From TOML. The error is one line: where, what, what to do.
    pub fn parse(text: &str) -> Result<Self, String> {
        let scenario: Self = toml::from_str(text).map_err(|error| one_line(text, &error))?;
        scenario.check()?;
        Ok(scenario)
    }
}

fn one_line(text: &str, error: &toml::de::Error) -> String {
    let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
    format!("line {line}: {}", error.message().replace('\n', " "))
}
