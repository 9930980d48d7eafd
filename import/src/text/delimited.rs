//! The table of a delimited text.

use super::column::{Column, Missing};
use super::comment::is_comment;
use super::dialect::Dialect;
use super::fields::{fields, trimmed};
use super::lines::{is_cut, lines};
use super::rows::{LARGEST_COLUMNS, Rows, are_text};
use super::signs::Delimiter;
use super::title::name_and_unit;
use crate::error::ImportError;
use crate::source::Source;

/// The table of a text.
///
/// # Errors
///
/// When it has more columns than any table of readings.
pub(crate) fn read(file: &str, text: &str, dialect: &Dialect) -> Result<Source, ImportError> {
    let width = dialect.width.max(dialect.names.len());
    if width > LARGEST_COLUMNS {
        let what = format!("has {width} fields: is this a table of readings?");
        return Err(ImportError::at(file, dialect.data_line.into(), what));
    }
    let data = &text[dialect.data_offset..];
    let first = lines(data).filter(|line| dialect.is_data(line.text));
    let are_text = are_text(first.map(|line| fields(line.text, dialect.delimiter)), width, dialect.decimal);
    let columns = are_text.into_iter().enumerate().map(|(at, is_text)| column(dialect, at, is_text)).collect();
    let rows = Rows::with_decimal(columns, dialect.decimal);
    let mut table = Table { dialect, rows };
    match dialect.delimiter {
        Delimiter::Byte(byte) => table.push_quoted(data, byte),
        Delimiter::Blanks => table.push_lines(data),
    }
    let table = table.rows.finish("a number where the others have one");
    Ok(Source { file: file.into(), format: "delimited text", tables: vec![table] })
}

/// With the unit of its row, else with that of its title.
fn column(dialect: &Dialect, at: usize, is_text: bool) -> Column {
    let title = dialect.names.get(at).map(String::as_str).unwrap_or_default();
    let (name, in_title) = name_and_unit(title);
    let below = dialect.units.get(at).map(|unit| unit.trim_matches(['[', ']', '(', ')', ' ']));
    let unit = below.filter(|unit| !unit.is_empty()).or(in_title.as_deref());
    let name = if name.is_empty() { format!("column_{}", at + 1) } else { name };
    Column::new(name, unit, Missing::Nothing, is_text)
}

/// A table while it is read.
struct Table<'a> {
    dialect: &'a Dialect,
    rows: Rows,
}

impl Table<'_> {
    /// Fields that may be quoted: the work is that of the `csv` crate.
    fn push_quoted(&mut self, data: &str, delimiter: u8) {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(delimiter)
            .trim(csv::Trim::None)
            .from_reader(data.as_bytes());
        let is_ended = data.ends_with('\n');
        let (mut record, mut before) = (csv::StringRecord::new(), csv::StringRecord::new());
        while reader.read_record(&mut record).unwrap_or(false) {
            let line = record.position().map_or(1, csv::Position::line);
            let is_last = !is_ended && reader.position().byte() >= data.len() as u64;
            let is_cut = is_last && self.is_cut(record.len(), last(&record), last(&before));
            let fields = record.iter().map(trimmed);
            self.push(u32::try_from(line).unwrap_or(u32::MAX), fields, record.len(), is_cut);
            std::mem::swap(&mut record, &mut before);
        }
    }

    fn push_lines(&mut self, data: &str) {
        let mut before = Vec::new();
        for line in lines(data) {
            let fields = fields(line.text, self.dialect.delimiter);
            let last = |fields: &[&'_ str]| fields.last().map_or(String::new(), |field| field.to_string());
            let is_cut = !line.is_ended && self.is_cut(fields.len(), &last(&fields), &last(&before));
            self.push(line.number, fields.iter().copied(), fields.len(), is_cut);
            before = fields;
        }
    }

    /// Whether the last record, which nothing ends, has lost fields or decimals.
    fn is_cut(&self, len: usize, last: &str, last_before: &str) -> bool {
        is_cut(false, len, self.dialect.width.min(self.rows.width()), last, last_before)
    }

    /// One record, whose line counts from that of the first.
    fn push<'f>(&mut self, line: u32, fields: impl Iterator<Item = &'f str> + Clone, len: usize, is_cut: bool) {
        let line = line.saturating_add(self.dialect.data_line - 1);
        if fields.clone().next().is_some_and(is_comment) || !self.rows.has_number(fields.clone()) {
            if fields.clone().any(|field| !field.is_empty()) {
                self.rows.skip(line);
            }
        } else if is_cut {
            // The last field of a cut line is not to be trusted.
            self.rows.push(line, fields.take(len - 1));
            self.rows.set_cut(line);
        } else {
            self.rows.push(line, fields);
        }
    }
}

fn last(record: &csv::StringRecord) -> &str {
    record.len().checked_sub(1).and_then(|at| record.get(at)).unwrap_or_default()
}
