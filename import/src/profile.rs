//! The profile of an import: what was taken for what. Given back, it gives the same recording.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use crate::axes::{Axis, parse_axes};
use crate::error::ImportError;
pub use crate::stamp::DateOrder;

/// What was asked for, or in the end taken. What is `None` or empty is found out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Profile {
    /// Format of this file.
    pub schema: u32,
    /// Sheet, group or sensor of the file that is taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// How a text is to be read.
    #[serde(skip_serializing_if = "TextProfile::is_empty")]
    pub text: TextProfile,
    /// Where the times come from.
    pub time: TimeProfile,
    /// Which column of the file each column of the recording comes from.
    pub columns: BTreeMap<String, ColumnProfile>,
    /// Forward, starboard and down in terms of the file's own axes, as in `["x", "-y", "-z"]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<[Axis; 3]>,
    /// Values that stand for "missing", beside those that are found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dummies: Vec<f64>,
    /// The scalar's readings are this much late, and are moved back, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scalar_lag_s: Option<f64>,
}

/// How a text is to be read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TextProfile {
    /// `comma`, `semicolon`, `tab`, `bar`, `blanks`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delimiter: Option<String>,
    /// `point`, `comma`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimal: Option<String>,
    /// A label of the web's encodings: `utf-8`, `windows-1252`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub encoding: Option<String>,
}

/// Where the times come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TimeProfile {
    /// One column, or a date and a time of day. Empty: rows come at `rate_hz`.
    pub columns: Vec<String>,
    /// What the column holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<TimeForm>,
    /// Which of day and month stands first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date_order: Option<DateOrder>,
    /// Date of the first row where the file does not tell, `2026-11-22`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Rows a second, where there are no times.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
}

/// What a column of times holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeForm {
    /// Seconds of any origin.
    Seconds,
    /// Milliseconds of any origin.
    Milliseconds,
    /// Microseconds of any origin.
    Microseconds,
    /// Nanoseconds of any origin.
    Nanoseconds,
    /// Days of a spreadsheet or of MATLAB.
    Days,
    /// The digits of a clock: 101036.4 is 10:10:36.4.
    ClockDigits,
    /// Text: dates, times of day or both.
    Stamps,
}

/// Where a column of the recording comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnProfile {
    /// Its name in the file.
    pub from: String,
    /// Times this, to the unit of the recording.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub factor: f64,
    /// Plus this, after the factor.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: f64,
}

fn one() -> f64 {
    1.0
}
fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}
fn is_zero(offset: &f64) -> bool {
    *offset == 0.0
}

impl TextProfile {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Profile {
    /// What a file of a profile says.
    ///
    /// # Errors
    ///
    /// When it is no profile, with the place.
    pub fn from_toml(file: &str, text: &str) -> Result<Self, ImportError> {
        let profile: Self = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start.min(text.len())].matches('\n').count());
            ImportError::at(file, line as u64, format!("{} in a profile of an import", error.message()))
        })?;
        if profile.schema > 1 {
            return Err(ImportError::file(file, "is a profile of a newer version of this program"));
        }
        Ok(profile)
    }

    /// As it is written beside the recording.
    pub fn to_toml(&self) -> String {
        let head = "# What the import took for what. Correct it and give it back with --profile: the same recording comes out.\n";
        format!("{head}{}", toml::to_string(self).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_survives_its_file() {
        let column = ColumnProfile { from: "RAW MAG".into(), factor: 1e3, offset: 0.0 };
        let profile = Profile {
            schema: 1,
            columns: BTreeMap::from([("scalar_nT".into(), column)]),
            axes: Some(parse_axes("y, x,-z").unwrap()),
            time: TimeProfile { columns: vec!["t".into()], form: Some(TimeForm::Milliseconds), ..Default::default() },
            ..Profile::default()
        };
        assert_eq!(Profile::from_toml("p", &profile.to_toml()).unwrap(), profile);
        assert_eq!(Profile::from_toml("p", "").unwrap(), Profile::default());
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        let error = Profile::from_toml("p.toml", "schema = 1\nspeed = 3\n").unwrap_err().to_string();
        assert!(error.starts_with("p.toml:2: ") && error.contains("speed"), "{error}");
    }
}
