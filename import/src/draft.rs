//! A recording in the making: columns with their meaning and unit, on times that are being put right.

use std::sync::Arc;

use towmag_recording::Column;

/// A recording in the making.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Draft {
    /// Of each row, s; NaN where there is none.
    pub time_s: Vec<f64>,
    /// Whether the times are points in time, since 1970.
    pub is_utc: bool,
    /// Whether the recording shall count from the midnight before its first row.
    pub is_clock: bool,
    /// Rows that may not be used.
    pub invalid: Vec<bool>,
    /// Everything but the time.
    pub columns: Vec<DraftColumn>,
}

/// A column of a [`Draft`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DraftColumn {
    /// As it will be in the recording.
    pub name: String,
    /// What it is, where that is known.
    pub known: Option<Column>,
    /// One a row.
    pub values: DraftValues,
    /// Whether its numbers are no longer those of the source: scaled, filtered, turned. They are rounded then.
    pub is_made: bool,
}

/// Values of a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DraftValues {
    /// NaN where one is missing.
    Numbers(Vec<f64>),
    /// Empty where one is missing.
    Labels(Vec<Arc<str>>),
}

impl Draft {
    /// How many rows.
    pub(crate) fn len(&self) -> usize {
        self.time_s.len()
    }

    /// A known column of numbers.
    pub(crate) fn numbers(&self, column: Column) -> Option<&[f64]> {
        self.columns.iter().find(|there| there.known == Some(column)).and_then(|there| there.values.numbers())
    }

    /// The same, to be changed.
    pub(crate) fn column_mut(&mut self, column: Column) -> Option<&mut DraftColumn> {
        self.columns.iter_mut().find(|there| there.known == Some(column))
    }

    /// The three axes of the fluxgate.
    pub(crate) fn flux(&self) -> Option<[&[f64]; 3]> {
        let [x, y, z] = Column::FLUX.map(|axis| self.numbers(axis));
        Some([x?, y?, z?])
    }

    /// The rows at these places, in this order.
    pub(crate) fn take(&mut self, rows: &[usize]) {
        let numbers = |values: &[f64]| rows.iter().map(|&row| values[row]).collect::<Vec<_>>();
        self.time_s = numbers(&self.time_s);
        self.invalid = rows.iter().map(|&row| self.invalid[row]).collect();
        for column in &mut self.columns {
            column.values = match &column.values {
                DraftValues::Numbers(values) => DraftValues::Numbers(numbers(values)),
                DraftValues::Labels(values) => {
                    DraftValues::Labels(rows.iter().map(|&row| values[row].clone()).collect())
                }
            };
        }
    }
}

impl DraftValues {
    /// Its numbers, if it has some.
    pub(crate) fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(numbers) => Some(numbers),
            Self::Labels(_) => None,
        }
    }
}

impl DraftColumn {
    /// Its numbers, to be changed; they are then no longer those of the source.
    pub(crate) fn make(&mut self) -> Option<&mut Vec<f64>> {
        self.is_made = true;
        match &mut self.values {
            DraftValues::Numbers(numbers) => Some(numbers),
            DraftValues::Labels(_) => None,
        }
    }
}
