//! The columns of a text: numbers where they are numbers, else text.

use std::collections::HashSet;
use std::sync::Arc;

use super::cell::{is_missing, parse_number};
use super::dialect::{Delimiter, Dialect, is_comment};
use super::lines::{Line, fields, lines};
use crate::error::ImportError;
use crate::source::{FindingKind, Note, Source, SourceColumn, SourceTable, Values};
use crate::units::name_and_unit;

/// So many rows tell whether a column holds numbers.
const LOOKED_AT: usize = 500;
/// More columns than any recording has: a file that claims them is none.
const MOST_COLUMNS: usize = 4096;

/// The table of a text.
///
/// # Errors
///
/// When it has more columns than any table of readings.
pub fn read(file: &str, text: &str, dialect: &Dialect) -> Result<Source, ImportError> {
    let width = dialect.width.max(dialect.names.len());
    if width > MOST_COLUMNS {
        return Err(ImportError::at(
            file,
            dialect.data_line,
            format!("has {width} fields: is this a table of readings?"),
        ));
    }
    let data = &text[dialect.data_offset..];
    let kinds = kinds(data, dialect, width);
    let mut table = Builder::new(dialect, kinds);
    match dialect.delimiter {
        Delimiter::Byte(byte) => table.push_quoted(data, byte),
        Delimiter::Blanks => {
            for line in lines(data) {
                table.push_line(line);
            }
        }
    }
    Ok(Source { file: file.into(), format: "delimited text", tables: vec![table.finish()] })
}

/// Whether each column holds text: most of its fields that are there are neither numbers nor missing.
fn kinds(data: &str, dialect: &Dialect, width: usize) -> Vec<bool> {
    let mut counts = vec![(0_usize, 0_usize); width];
    for line in lines(data).filter(|line| dialect.is_data(line.text)).take(LOOKED_AT) {
        for (field, (there, words)) in fields(line.text, dialect.delimiter).iter().zip(&mut counts) {
            if !is_missing(field) {
                *there += 1;
                *words += usize::from(parse_number(field, dialect.decimal).is_none());
            }
        }
    }
    counts.iter().map(|(there, words)| words * 2 > *there).collect()
}

/// A table while it is read.
struct Builder<'a> {
    dialect: &'a Dialect,
    columns: Vec<Values>,
    shared: HashSet<Arc<str>>,
    places: Vec<u32>,
    bad: Option<(usize, u64, String)>,
    longer: Option<(usize, u64)>,
    skipped: Option<(usize, u64)>,
    missing: Option<(usize, u64, String)>,
    truncated: Option<u64>,
    /// The last field of the row before.
    last_field: String,
}

impl<'a> Builder<'a> {
    fn new(dialect: &'a Dialect, texts: Vec<bool>) -> Self {
        let column = |is_text: bool| if is_text { Values::Text(Vec::new()) } else { Values::Numbers(Vec::new()) };
        Self {
            dialect,
            columns: texts.into_iter().map(column).collect(),
            shared: HashSet::new(),
            places: Vec::new(),
            bad: None,
            longer: None,
            skipped: None,
            missing: None,
            truncated: None,
            last_field: String::new(),
        }
    }

    /// Fields that may be quoted: the work is that of the `csv` crate.
    fn push_quoted(&mut self, data: &str, delimiter: u8) {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(delimiter)
            .trim(csv::Trim::None)
            .from_reader(data.as_bytes());
        let is_ended = data.ends_with(['\n', '\r']);
        let (mut record, first) = (csv::ByteRecord::new(), self.dialect.data_line - 1);
        while reader.read_byte_record(&mut record).unwrap_or(false) {
            let line = first + record.position().map_or(0, csv::Position::line);
            let is_last = !is_ended && reader.position().byte() >= data.len() as u64;
            self.push(line, record.len(), record.iter().map(trimmed), is_last);
        }
    }

    fn push_line(&mut self, line: Line<'_>) {
        let number = line.number + self.dialect.data_line - 1;
        let fields = fields(line.text, self.dialect.delimiter);
        self.push(number, fields.len(), fields.into_iter(), !line.is_ended);
    }

    /// One record. `is_last`: nothing ends it, it may be cut.
    fn push<'f>(&mut self, line: u64, len: usize, fields: impl Iterator<Item = &'f str> + Clone, is_last: bool) {
        if fields.clone().next().is_some_and(is_comment) || !self.is_row(fields.clone()) {
            if fields.clone().any(|field| !field.is_empty()) {
                count(&mut self.skipped, line);
            }
            return;
        }
        let last_field = fields.clone().last().unwrap_or_default();
        let cut = is_last && self.is_cut(len, last_field);
        let mut given = fields;
        for column in 0..self.columns.len() {
            // Of a cut line the last field is not to be trusted.
            let field = given.next().filter(|_| !cut || column + 1 < len).unwrap_or_default();
            self.push_field(column, field, line);
        }
        if cut {
            self.truncated = Some(line);
        }
        self.last_field.clear();
        self.last_field.push_str(last_field);
        if given.any(|field| !field.is_empty()) {
            count(&mut self.longer, line);
        }
        self.places.push(u32::try_from(line).unwrap_or(u32::MAX));
    }

    /// Whether the file ends within this line: fields are missing, or decimals that the row before has.
    fn is_cut(&self, len: usize, last_field: &str) -> bool {
        let decimals = |field: &str| field.rsplit_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
        len < self.dialect.width.min(self.columns.len()) || decimals(last_field) < decimals(&self.last_field)
    }

    /// At least one column of numbers has one: it is neither a title nor a header that comes again.
    fn is_row<'f>(&self, fields: impl Iterator<Item = &'f str>) -> bool {
        self.columns.iter().zip(fields).any(|(column, field)| {
            matches!(column, Values::Numbers(_)) && parse_number(field, self.dialect.decimal).is_some()
        })
    }

    fn push_field(&mut self, column: usize, field: &str, line: u64) {
        match &mut self.columns[column] {
            Values::Numbers(numbers) | Values::Times(numbers) => {
                let number = parse_number(field, self.dialect.decimal);
                numbers.push(number.unwrap_or(f64::NAN));
                if number.is_none() && !field.is_empty() {
                    let what = if is_missing(field) { &mut self.missing } else { &mut self.bad };
                    what.get_or_insert_with(|| (0, line, field.chars().take(20).collect())).0 += 1;
                }
            }
            Values::Text(texts) => {
                let text = if is_missing(field) { "" } else { field };
                texts.push(shared(&mut self.shared, text));
            }
        }
    }

    fn finish(self) -> SourceTable {
        let notes = self.notes();
        let Self { dialect, columns, places, .. } = self;
        let columns = columns.into_iter().enumerate().map(|(at, values)| named(dialect, at, values)).collect();
        SourceTable { rows: places.len(), columns, places, notes, ..SourceTable::default() }
    }

    fn notes(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let mut note = |kind, text| notes.push(Note { kind, text });
        if let Some((count, line, field)) = &self.bad {
            let text = format!(
                "{count} fields are no numbers and were taken as missing, the first \"{field}\" in line {line}"
            );
            note(FindingKind::Dummies, text);
        }
        if let Some((count, line, field)) = &self.missing {
            let text = format!("\"{field}\" stands for \"missing\": {count} fields, the first in line {line}");
            note(FindingKind::Dummies, text);
        }
        if let Some((count, line)) = self.longer {
            let text =
                format!("{count} rows have more fields than columns, the first is line {line}: those were left out");
            note(FindingKind::Delimiter, text);
        }
        if let Some((count, line)) = self.skipped {
            let text = format!("{count} lines among the data are none and were left out, the first is line {line}");
            note(FindingKind::Delimiter, text);
        }
        if let Some(line) = self.truncated {
            note(FindingKind::Truncated, format!("the file ends within line {line}: what is cut counts as missing"));
        }
        notes
    }
}

/// A text that is there already is not stored again.
fn shared(shared: &mut HashSet<Arc<str>>, text: &str) -> Arc<str> {
    if let Some(there) = shared.get(text) {
        return there.clone();
    }
    let new: Arc<str> = text.into();
    // Labels come again and again, stamps never do.
    if shared.len() < 1000 {
        shared.insert(new.clone());
    }
    new
}

fn trimmed(field: &[u8]) -> &str {
    std::str::from_utf8(field).unwrap_or_default().trim()
}

fn count(what: &mut Option<(usize, u64)>, line: u64) {
    what.get_or_insert((0, line)).0 += 1;
}

fn named(dialect: &Dialect, at: usize, values: Values) -> SourceColumn {
    let given = dialect.names.get(at).map(String::as_str).unwrap_or_default();
    let (name, mut unit) = name_and_unit(given);
    if let Some(told) = dialect.units.get(at).filter(|unit| !unit.is_empty()) {
        unit = Some(told.trim_matches(['[', ']', '(', ')', ' ']).to_string());
    }
    let name = if name.is_empty() { format!("column_{}", at + 1) } else { name };
    SourceColumn { name, unit, values, dummy: None }
}
