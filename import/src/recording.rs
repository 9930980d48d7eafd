//! The recording that comes out: its text, and what is told of the import.

use std::io::{self, Write};

use serde::Serialize;
use towmag_recording::{COLUMNS, Column};

use crate::draft::{Draft, DraftColumn, DraftValues};
use crate::finding::Finding;
use crate::profile::Profile;
use crate::stamp::DAY_S;

/// A recording in this project's format, and how it came about.
#[derive(Clone, Debug)]
pub struct Recording {
    pub(crate) draft: Draft,
    /// What was taken for what.
    pub profile: Profile,
    /// What is told of it.
    pub report: Report,
}

/// `REC.import.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Format of the file.
    pub schema: u32,
    /// What the file is: "delimited text".
    pub format: String,
    /// Rows of the file.
    pub rows_in: usize,
    /// Rows of the recording.
    pub rows_out: usize,
    /// Rows of the recording that may not be used.
    pub rows_invalid: usize,
    /// Rows of the file that have no place in the recording.
    pub rows_left_out: usize,
    /// Rows a second of the recording.
    pub rate_hz: f64,
    /// Rows a second of the file.
    pub source_rate_hz: f64,
    /// Columns of the recording, and what they were in the file.
    pub columns: std::collections::BTreeMap<String, String>,
    /// What was found.
    pub findings: Vec<Finding>,
}

impl Recording {
    /// The recording as CSV.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let draft = &self.draft;
        let origin_s = self.origin_s();
        let flag = self.needs_flag();
        let has_utc = draft.columns.iter().any(|column| column.known == Some(Column::Utc));
        let tells_utc = draft.is_utc && !has_utc;
        let columns = self.ordered();
        let mut writer = csv::Writer::from_writer(out);
        let names = columns.iter().map(|column| column.name.as_str());
        let extra = flag.then_some("scalar_valid").into_iter().chain(tells_utc.then_some("utc_s"));
        writer.write_record(std::iter::once("time_s").chain(names).chain(extra))?;
        let mut digits = zmij::Buffer::new();
        for row in 0..draft.len() {
            writer.write_field(digits.format(short(draft.time_s[row] - origin_s)).trim_end_matches(".0"))?;
            for column in &columns {
                write_value(&mut writer, column, row, draft.invalid[row], &mut digits)?;
            }
            if flag {
                writer.write_field(if draft.invalid[row] { "0" } else { "1" })?;
            }
            if tells_utc {
                writer.write_field(digits.format(short(draft.time_s[row])).trim_end_matches(".0"))?;
            }
            writer.write_record(None::<&[u8]>)?;
        }
        writer.flush()
    }

    /// A clock's stamps count from the midnight before the first row: short numbers, and the origin that people expect.
    fn origin_s(&self) -> f64 {
        let first = self.draft.time_s.first().copied().unwrap_or_default();
        if self.draft.is_clock { (first / DAY_S).floor() * DAY_S } else { 0.0 }
    }

    /// Rows are invalid and no column says so.
    fn needs_flag(&self) -> bool {
        let has_flag = self.draft.columns.iter().any(|column| column.known == Some(Column::ScalarValid));
        !has_flag && self.draft.invalid.contains(&true)
    }

    /// Known columns in the order of the contract, then loads, then what is carried.
    fn ordered(&self) -> Vec<&DraftColumn> {
        let known =
            |spec: &towmag_recording::ColumnSpec| self.draft.columns.iter().find(|c| c.known == Some(spec.column));
        let mut columns: Vec<&DraftColumn> = COLUMNS.iter().filter_map(known).collect();
        columns.extend(self.draft.columns.iter().filter(|column| column.known.is_none()));
        columns
    }
}

fn write_value<W: Write>(
    writer: &mut csv::Writer<W>,
    column: &DraftColumn,
    row: usize,
    is_invalid: bool,
    digits: &mut zmij::Buffer,
) -> csv::Result<()> {
    match &column.values {
        DraftValues::Labels(labels) => writer.write_field(labels[row].as_bytes()),
        DraftValues::Numbers(_) if column.known == Some(Column::ScalarValid) && is_invalid => writer.write_field("0"),
        DraftValues::Numbers(numbers) if numbers[row].is_finite() => {
            let number = if column.is_made { rounded(column, numbers[row]) } else { numbers[row] };
            writer.write_field(digits.format(number).trim_end_matches(".0"))
        }
        DraftValues::Numbers(_) => writer.write_field(""),
    }
}

/// Below what any sensor tells: a tenth of a picotesla, a tenth of a millimetre on the ground.
fn rounded(column: &DraftColumn, number: f64) -> f64 {
    let places = match column.known {
        Some(Column::Latitude | Column::Longitude) => 1e9,
        Some(known) if known.spec().unit == "nT" => 1e4,
        _ => 1e6,
    };
    let rounded = (number * places).round() / places;
    if rounded.is_finite() { rounded } else { number }
}

/// A time without the last bits of its sums.
fn short(time_s: f64) -> f64 {
    (time_s * 1e6).round() / 1e6
}

impl Report {
    /// What the terminal shows: a line each.
    pub fn lines(&self) -> Vec<String> {
        let rate = |rate_hz: f64| format!("{} Hz", (rate_hz * 100.0).round() / 100.0);
        let mut lines = vec![format!("{}: {} rows at {}", self.format, self.rows_in, rate(self.source_rate_hz))];
        let columns = self.columns.iter().filter(|(target, source)| target != source);
        let taken: Vec<String> = columns.map(|(target, source)| format!("{target} <- {source}")).collect();
        if !taken.is_empty() {
            lines.push(taken.join(", "));
        }
        for finding in &self.findings {
            let (mark, option) = (
                if finding.is_warning { "warning: " } else { "" },
                finding.option.as_ref().map(|option| format!(" ({option})")).unwrap_or_default(),
            );
            lines.push(format!("{mark}{}{option}", finding.text));
        }
        let (out, invalid, left) = (self.rows_out, self.rows_invalid, self.rows_left_out);
        lines.push(format!("{out} rows at {}, {invalid} of them invalid; {left} rows left out", rate(self.rate_hz)));
        lines
    }
}
