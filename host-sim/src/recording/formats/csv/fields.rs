//! From the text of a row to its values, and what counts as bad input.

use csv::ByteRecord;

use crate::message::quoted;
use crate::recording::bad_rows::RowFault;
use crate::recording::error::BadInput;
use crate::recording::row::RecordingRow;
use crate::recording::schema::Schema;
use towmag_recording::Column;

/// The text of one row.
pub(super) struct Fields<'a> {
    pub(super) record: &'a ByteRecord,
    pub(super) schema: &'a Schema,
}

impl Fields<'_> {
    /// Set all values of `row`.
    ///
    /// A row that is never used may hold whatever it likes: what is no number there counts as missing.
    pub(super) fn set_values(&self, row: &mut RecordingRow) -> Result<(), BadInput> {
        let is_complete = self.schema.required().iter().all(|&position| !self.trimmed(position).is_empty());
        let valid = match self.schema.position(Column::ScalarValid).map_or(Ok(None), |at| self.flag(at)) {
            Err(bad) if is_complete => return Err(bad),
            valid => valid.unwrap_or(Some(false)),
        };
        self.fill(row, valid, is_complete && valid != Some(false))
    }

    /// Set all values of a row that shall not be used: what is no number counts as missing.
    pub(super) fn set_unused(&self, row: &mut RecordingRow) {
        // Only a row that is usable can be bad.
        let _always_ok = self.fill(row, Some(false), false);
    }

    fn fill(&self, row: &mut RecordingRow, valid: Option<bool>, is_usable: bool) -> Result<(), BadInput> {
        row.clear();
        for &(column, position) in self.schema.numbers() {
            row.set(column, self.number(position, is_usable)?);
        }
        for &(column, position) in self.schema.flags().iter().filter(|(column, _)| *column != Column::ScalarValid) {
            let flag = self.flag(position).or_else(|bad| if is_usable { Err(bad) } else { Ok(None) })?;
            row.set(column, flag.map(f64::from));
        }
        row.set(Column::ScalarValid, valid.map(f64::from));
        for load in self.schema.loads() {
            row.currents_a.push(self.number(load.position, is_usable)?);
        }
        if let Some(position) = self.schema.position(Column::Line) {
            row.line.push_str(&String::from_utf8_lossy(self.record.get(position).unwrap_or_default()));
        }
        Ok(())
    }

    fn trimmed(&self, position: usize) -> &[u8] {
        self.record.get(position).unwrap_or_default().trim_ascii()
    }

    /// A finite number, or nothing. Anything else is bad input in a row that `is_usable`, and as good as missing elsewhere.
    fn number(&self, position: usize, is_usable: bool) -> Result<Option<f64>, BadInput> {
        let field = self.trimmed(position);
        if field.is_empty() {
            return Ok(None);
        }
        match parse(field) {
            Some(value) if value.is_finite() => Ok(Some(value)),
            _ if !is_usable => Ok(None),
            value => Err(self.no_number(position, value)),
        }
    }

    #[cold]
    fn no_number(&self, position: usize, value: Option<f64>) -> BadInput {
        let finite = if value.is_some() { "finite " } else { "" };
        let field = quoted(self.trimmed(position));
        BadInput::of(self.schema.name(position), format!("{field} is not a {finite}number"))
            .in_row(RowFault::NotANumber)
    }

    fn flag(&self, position: usize) -> Result<Option<bool>, BadInput> {
        let field = self.trimmed(position);
        match field {
            b"" => return Ok(None),
            b"1" => return Ok(Some(true)),
            b"0" => return Ok(Some(false)),
            _ => {}
        }
        match parse(field) {
            Some(1.0) => Ok(Some(true)),
            Some(0.0) => Ok(Some(false)),
            _ => {
                let what = format!("{} is neither 1 nor 0", quoted(field));
                Err(BadInput::of(self.schema.name(position), what).in_row(RowFault::NotAFlag))
            }
        }
    }
}

/// A finite number; nothing where there is none.
pub(super) fn finite(field: &[u8]) -> Option<f64> {
    parse(field.trim_ascii()).filter(|value| value.is_finite())
}

fn parse(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// By the digits behind the point. Not by a power: its last bit is the compiler's.
const STEPS: [f64; 10] = [1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];

/// The step of a number's last digit, as far as it means something: the shortest text of an `f64` has up to 17 digits.
/// `None` for a field that is empty.
pub(super) fn step_of(field: &[u8]) -> Option<f64> {
    let field = field.trim_ascii();
    (!field.is_empty()).then(|| STEPS[decimals_of(field)])
}

/// Digits behind the point.
pub(super) fn decimals_of(field: &[u8]) -> usize {
    if field.iter().any(|byte| matches!(byte, b'e' | b'E')) {
        return 9;
    }
    let after = field.iter().rev().position(|&byte| byte == b'.');
    after.map_or(0, |count| count.min(9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_those_of_the_text() {
        let step = |text: &str| step_of(text.as_bytes());
        assert_eq!(["50000", "50000.10 ", "-0.125", "5e4"].map(step), [1.0, 0.01, 1e-3, 1e-9].map(Some));
        assert_eq!([" ", ""].map(step), [None, None]);
    }
}
