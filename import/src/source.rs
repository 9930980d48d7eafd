//! What a file holds, before anyone has said what it means: what every reader of a format gives.

use std::sync::Arc;

/// Everything that one file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// As the user named it.
    pub file: String,
    /// What the file is, in words for the user: "delimited text", "Geosoft XYZ", "MagNav HDF5".
    pub format: &'static str,
    /// Its tables: sheets of a workbook, groups of a file, kinds of sentences; for most formats one.
    pub tables: Vec<SourceTable>,
}

/// A table: columns of the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceTable {
    /// Name of the sheet, group or kind; empty where the format has but one.
    pub name: String,
    /// How many rows every column has.
    pub rows: usize,
    /// Its columns, in the order of the file.
    pub columns: Vec<SourceColumn>,
    /// Where each row stands in the file, for messages: line, row of the sheet, or index, from 1. Empty: row + 1.
    pub places: Vec<u32>,
    /// What the file says beside its columns.
    pub facts: Facts,
    /// What a reader had to put right or leave out, one sentence each, for the user.
    pub notes: Vec<Note>,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceColumn {
    /// As in the file, trimmed; empty where the file gives none.
    pub name: String,
    /// As the file gives it, in a row of units, in brackets or in a definition; not repeated in `name`.
    pub unit: Option<String>,
    /// One value a row.
    pub values: Values,
    /// The value that stands for "missing", where the format says so. Readers turn it into NaN themselves and tell it here.
    pub dummy: Option<f64>,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// NaN where a value is missing.
    Numbers(Vec<f64>),
    /// Empty where a value is missing. The same text is shared.
    Text(Vec<Arc<str>>),
    /// Points in time of a format that has a type for them: seconds since 1970-01-01 UTC (or since midnight, or since an
    /// unknown origin: see [`Facts::clock`]); NaN where one is missing.
    Times(Vec<f64>),
}

/// What a file says of all of its rows, as far as it does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// Rows a second.
    pub rate_hz: Option<f64>,
    /// Date of the first row, (year, month, day).
    pub date: Option<(i16, i8, i8)>,
    /// Which clock its stamps follow.
    pub clock: Clock,
    /// WGS 84, of a station that does not move.
    pub position_deg: Option<(f64, f64)>,
    /// What is not in the columns and a person may want to know: the name of the instrument or of the station.
    pub instrument: Option<String>,
}

/// Which clock stamps follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clock {
    /// Not told: UTC where they are dates.
    #[default]
    Untold,
    /// UTC.
    Utc,
    /// GPS time, which is ahead of UTC by the leap seconds since 1980.
    Gps,
}

/// Something that a reader did to the data, or could not do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Which sort of finding.
    pub kind: FindingKind,
    /// One sentence.
    pub text: String,
}

/// The sorts of findings, as in the contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// What parts the fields.
    Delimiter,
    /// Of a column.
    Units,
    /// Rows a second.
    Rate,
    /// Which axis is which.
    Axes,
    /// A left-handed set of axes.
    Handedness,
    /// Scalar and fluxgate out of step.
    Lag,
    /// A reading that does not move.
    Stuck,
    /// Columns in each other's place.
    Swapped,
    /// Values that stand for "missing".
    Dummies,
    /// Rows in another order than their times.
    Order,
    /// The file ends within a row.
    Truncated,
    /// One of several was taken.
    Choice,
    /// Something is not there.
    Missing,
}

impl SourceColumn {
    /// A column of numbers without a unit.
    pub fn numbers(name: impl Into<String>, numbers: Vec<f64>) -> Self {
        Self { name: name.into(), unit: None, values: Values::Numbers(numbers), dummy: None }
    }

    /// The same with this unit.
    pub fn in_unit(self, unit: impl Into<String>) -> Self {
        Self { unit: Some(unit.into()).filter(|unit: &String| !unit.is_empty()), ..self }
    }

    /// Its numbers, if it has some.
    pub fn as_numbers(&self) -> Option<&[f64]> {
        match &self.values {
            Values::Numbers(numbers) => Some(numbers),
            Values::Text(_) | Values::Times(_) => None,
        }
    }
}

impl Values {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) | Self::Times(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
