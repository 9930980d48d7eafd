//! A table out of fields that have names, where nothing but their lengths says which belong together: HDF5, MATLAB.

mod units;

use std::sync::Arc;

use crate::error::ImportError;
use crate::source::{Facts, FindingKind, Note, SourceColumn, SourceTable, Values};

pub(super) use self::units::with_known_units;

/// More columns than that in one array are a picture or a matrix, not readings.
const WIDEST: usize = 64;

/// A field as its file describes it. `data` is how to come by its values.
#[derive(Clone, Debug)]
pub(super) struct Field<T> {
    /// As in the file.
    pub(super) name: String,
    /// Its sizes without those of one; the first is that along which values are neighbours.
    sizes: Vec<usize>,
    /// Values, or where they are.
    pub(super) data: T,
}

/// Fields that stand together: of a file, a group, a struct.
#[derive(Clone, Debug)]
pub(super) struct Part<T> {
    /// Of the group; empty for the file's own.
    pub(super) name: String,
    /// In the file's order.
    pub(super) fields: Vec<Field<T>>,
}

impl<T> Field<T> {
    /// `sizes`: that along which values are neighbours comes first.
    pub(super) fn new(name: impl Into<String>, sizes: impl Iterator<Item = usize>, data: T) -> Self {
        Self { name: name.into(), sizes: sizes.filter(|size| *size != 1).collect(), data }
    }

    /// Whether it is one value.
    pub(super) fn is_single(&self) -> bool {
        self.sizes.is_empty()
    }

    /// How many values it has.
    pub(super) fn count(&self) -> usize {
        self.sizes.iter().fold(1, |count: usize, size| count.saturating_mul(*size))
    }

    /// How many rows it would have in a table; none if it is no column.
    fn rows(&self) -> Option<usize> {
        let rows = self.sizes.iter().copied().max().filter(|rows| *rows > 0 && self.sizes.len() <= 2)?;
        let across = self.sizes.iter().copied().min().filter(|_| self.sizes.len() == 2).unwrap_or(1);
        (1..=WIDEST).contains(&across).then_some(rows)
    }

    /// Its values as columns of so many rows.
    pub(super) fn columns(&self, values: Values, rows: usize) -> Vec<SourceColumn> {
        let column = |name: String, values| SourceColumn { name, unit: None, values, dummy: None };
        match values {
            Values::Numbers(numbers) if numbers.len() > rows => (0..numbers.len() / rows)
                .map(|index| column(format!("{}_{}", self.name, index + 1), self.column(&numbers, rows, index)))
                .collect(),
            values => vec![column(self.name.clone(), values)],
        }
    }

    fn column(&self, numbers: &[f64], rows: usize, index: usize) -> Values {
        if self.sizes.first() == Some(&rows) {
            return Values::Numbers(numbers.iter().skip(index * rows).take(rows).copied().collect());
        }
        Values::Numbers(numbers.iter().skip(index).step_by(numbers.len() / rows).take(rows).copied().collect())
    }
}

/// What stands before the names of fields of a struct or group within another. MagNav.jl keeps the track in `traj`; its files
/// have the same fields without that.
pub(super) fn prefix(outer: &str, name: &str) -> String {
    if name == "traj" { outer.to_owned() } else { format!("{outer}{name}_") }
}

/// The part that the user asked for, or the first of those with most columns.
pub(super) fn choose<T>(
    file: &str,
    parts: Vec<Part<T>>,
    wanted: Option<&str>,
) -> Result<(Part<T>, Vec<Note>), ImportError> {
    let mut parts: Vec<Part<T>> =
        parts.into_iter().filter(|part| part.fields.iter().any(|field| field.rows().is_some())).collect();
    let names = parts.iter().map(|part| format!("\"{}\"", part.name)).collect::<Vec<_>>().join(", ");
    if parts.is_empty() {
        return Err(ImportError::file(file, "holds no columns: none of its fields is a list of numbers"));
    }
    let Some(wanted) = wanted else {
        let columns = |part: &Part<T>| part.fields.iter().filter(|field| field.rows().is_some()).count();
        let most = parts.iter().map(columns).max();
        let taken = parts.iter().position(|part| Some(columns(part)) == most).unwrap_or(0);
        let text = format!("took \"{}\" of {names}", parts[taken].name);
        let notes = if parts.len() > 1 { vec![Note { kind: FindingKind::Choice, text }] } else { Vec::new() };
        return Ok((parts.swap_remove(taken), notes));
    };
    match parts.iter().position(|part| part.name == wanted) {
        Some(index) => Ok((parts.swap_remove(index), Vec::new())),
        None => Err(ImportError::file(file, format!("has no part \"{wanted}\"; it has {names}"))),
    }
}

/// How many rows the table of these fields has: what the file says itself, else what most of them have.
pub(super) fn rows<T>(fields: &[Field<T>], told: Option<usize>) -> usize {
    let lengths: Vec<usize> = fields.iter().filter_map(Field::rows).collect();
    let count = |length: usize| lengths.iter().filter(|other| **other == length).count();
    let most = || lengths.iter().copied().max_by_key(|length| (count(*length), *length));
    told.filter(|told| lengths.contains(told)).or_else(most).unwrap_or(0)
}

/// The fields that have so many rows, and the names of the others.
pub(super) fn of_length<T>(fields: Vec<Field<T>>, rows: usize) -> (Vec<Field<T>>, Vec<String>) {
    let (taken, others): (Vec<_>, Vec<_>) = fields.into_iter().partition(|field| field.rows() == Some(rows));
    (taken, others.into_iter().filter(|field| !field.is_single()).map(|field| field.name).collect())
}

/// The table of these columns. `interval_s` is what the file says of the time between rows.
pub(super) fn table(
    name: String,
    rows: usize,
    columns: Vec<SourceColumn>,
    interval_s: Option<f64>,
    left_out: &[String],
) -> SourceTable {
    let rate_hz = interval_s.filter(|interval| *interval > 0.0).map(f64::recip).filter(|rate| rate.is_finite());
    let mut notes = Vec::new();
    if !left_out.is_empty() {
        let text = format!("left out, not being columns of {rows} numbers: {}", left_out.join(", "));
        notes.push(Note { kind: FindingKind::Choice, text });
    }
    SourceTable { name, rows, columns, facts: Facts { rate_hz, ..Facts::default() }, notes, places: Vec::new() }
}

/// Texts as a column's values; equal neighbours share their memory.
pub(super) fn texts(texts: impl Iterator<Item = String>) -> Values {
    let mut shared: Vec<Arc<str>> = Vec::new();
    for text in texts {
        let text = text.trim_matches(['\0', ' ']);
        let same = shared.last().filter(|last| ***last == *text).cloned();
        shared.push(same.unwrap_or_else(|| text.into()));
    }
    Values::Text(shared)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(name: &str, sizes: &[usize]) -> Field<()> {
        Field::new(name, sizes.iter().copied(), ())
    }

    #[test]
    fn what_the_file_says_of_its_rows_goes_before_what_most_fields_have() {
        let fields = [field("a", &[4]), field("b", &[1, 4]), field("c", &[7]), field("picture", &[90, 90])];
        assert_eq!(rows(&fields, None), 4);
        assert_eq!(rows(&fields, Some(7)), 7);
        assert_eq!(rows(&fields, Some(5)), 4);
        let (taken, others) = of_length(fields.to_vec(), 4);
        assert_eq!(taken.len(), 2);
        assert_eq!(others, ["c", "picture"]);
    }

    #[test]
    fn an_array_of_three_columns_comes_apart_whichever_way_it_lies() {
        let numbers = |values: &[f64]| Values::Numbers(values.to_vec());
        let along = field("f", &[2, 3]).columns(numbers(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), 2);
        let across = field("f", &[2, 3]).columns(numbers(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), 3);
        assert_eq!(along[2], SourceColumn::numbers("f_3", vec![5.0, 6.0]));
        assert_eq!(across[1], SourceColumn::numbers("f_2", vec![2.0, 4.0, 6.0]));
    }

    #[test]
    fn a_part_that_is_not_there_is_answered_with_those_that_are() {
        let part = |name: &str| Part { name: name.into(), fields: vec![field("a", &[9])] };
        let (first, notes) = choose("f", vec![part("one"), part("two")], None).unwrap();
        assert_eq!((first.name.as_str(), notes.len()), ("one", 1));
        let refusal = choose("f", vec![part("one"), part("two")], Some("three")).unwrap_err();
        assert_eq!(refusal.to_string(), "f: has no part \"three\"; it has \"one\", \"two\"");
    }
}
