//! Rows that are no good and were read past: how many, of which kinds, and where the first of them are.

use std::fmt;

use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::text::number::group;

/// How many of them are listed.
const LISTED: usize = 20;

/// One row in so many may be bad; above it the file is taken for something else than it says.
const ONE_IN: u64 = 10;

/// What can be wrong with a row while those around it are good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowFault {
    /// A field holds something else than a finite number.
    NotANumber,
    /// A flag is neither 1 nor 0.
    NotAFlag,
    /// A reading is none that the Earth has.
    OutOfRange,
    /// The time lies before that of the row before.
    BackwardTime,
    /// The time is that of the row before.
    RepeatedTime,
    /// The row comes less than half an epoch after the one before.
    ShortStep,
    /// The time lies after that of the rows behind it.
    ForwardTime,
    /// The row has more or fewer fields than the header.
    FieldCount,
    /// The last line is cut.
    TruncatedLine,
}

impl RowFault {
    /// Every kind, in the order in which they are told.
    pub const ALL: [Self; 9] = [
        Self::NotANumber,
        Self::NotAFlag,
        Self::OutOfRange,
        Self::BackwardTime,
        Self::RepeatedTime,
        Self::ShortStep,
        Self::ForwardTime,
        Self::FieldCount,
        Self::TruncatedLine,
    ];

    /// Its name in `summary.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotANumber => "not_a_number",
            Self::NotAFlag => "not_a_flag",
            Self::OutOfRange => "out_of_range",
            Self::BackwardTime => "backward_time",
            Self::RepeatedTime => "repeated_time",
            Self::ShortStep => "short_step",
            Self::ForwardTime => "forward_time",
            Self::FieldCount => "field_count",
            Self::TruncatedLine => "truncated_line",
        }
    }

    /// What a file most likely is where this is the most frequent fault.
    fn likely_cause(self) -> &'static str {
        match self {
            Self::NotANumber => "the recorder writes something else than numbers there",
            Self::NotAFlag => "the flag is written in another way",
            Self::OutOfRange => "another unit than nT, another column, or a number that stands for a missing one",
            Self::BackwardTime => "the clock was set back, or the parts are not in order of time",
            Self::RepeatedTime => "the times are coarser than the rows, or rows are there twice",
            Self::ShortStep => "the rate is not 10 Hz, or the times are irregular",
            Self::ForwardTime => "the clock jumps",
            Self::FieldCount => "another delimiter, a decimal comma, or damaged lines",
            Self::TruncatedLine => "the file was cut",
        }
    }
}

/// Where and what a bad row is.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct BadRow {
    /// Physical line in the file, from 1.
    pub line: u64,
    /// Column, or columns, at fault; `None` when the line as a whole is.
    pub column: Option<String>,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for BadRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, what } = self;
        let column = column.as_ref().map(|column| format!("{column}: ")).unwrap_or_default();
        write!(f, "line {line}, {column}{what}")
    }
}

/// How often each kind was seen, in the order of [`RowFault::ALL`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Kinds([u64; RowFault::ALL.len()]);

impl Kinds {
    fn of(&self, fault: RowFault) -> u64 {
        self.0[fault as usize]
    }

    /// The kinds that were seen, the most frequent first.
    fn seen(&self) -> Vec<RowFault> {
        let mut seen: Vec<RowFault> = RowFault::ALL.into_iter().filter(|&fault| self.of(fault) > 0).collect();
        seen.sort_by_key(|&fault| std::cmp::Reverse(self.of(fault)));
        seen
    }
}

impl Serialize for Kinds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(RowFault::ALL.len()))?;
        RowFault::ALL.into_iter().try_for_each(|fault| map.serialize_entry(fault.name(), &self.of(fault)))?;
        map.end()
    }
}

/// The bad rows of a recording: carried through, never used.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct BadRows {
    /// How many rows.
    pub count: u64,
    /// How many of all rows.
    pub share: f64,
    kinds: Kinds,
    /// The first of them.
    pub first: Vec<BadRow>,
    /// Lines at which the time of day begins anew; from each on a day was added.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub midnight_lines: Vec<u64>,
    /// What stands still while the body moves, a sentence each.
    #[serde(skip)]
    pub(super) standing_still: Vec<String>,
    #[serde(skip)]
    rows: u64,
}

impl BadRows {
    /// How many rows have this fault first.
    pub fn of(&self, fault: RowFault) -> u64 {
        self.kinds.of(fault)
    }

    /// Whether there is nothing to tell.
    pub fn is_empty(&self) -> bool {
        self.count == 0 && self.midnight_lines.is_empty()
    }

    /// The same, each place with the name of its file: for the bad rows of several files.
    pub fn of_file(&self, file: &str) -> Self {
        let mut named = self.clone();
        named.first.iter_mut().for_each(|row| row.what = format!("{file}: {}", row.what));
        named.standing_still.iter_mut().for_each(|still| *still = format!("{file}: {still}"));
        named
    }

    /// Those of two files.
    pub fn and(mut self, other: Self) -> Self {
        self.count += other.count;
        self.rows += other.rows;
        self.share = self.count as f64 / self.rows.max(1) as f64;
        self.kinds.0.iter_mut().zip(other.kinds.0).for_each(|(kind, more)| *kind += more);
        self.first.extend(other.first);
        self.first.truncate(LISTED);
        self.midnight_lines.extend(other.midnight_lines);
        self.standing_still.extend(other.standing_still);
        self
    }

    /// One more row, good or bad.
    pub(super) fn count_row(&mut self) {
        self.rows += 1;
        self.share = self.count as f64 / self.rows as f64;
    }

    /// The row that was counted last is bad.
    pub(super) fn add(&mut self, fault: RowFault, row: BadRow) {
        self.count += 1;
        self.share = self.count as f64 / self.rows as f64;
        self.kinds.0[fault as usize] += 1;
        if self.first.len() < LISTED {
            self.first.push(row);
        }
    }

    /// Why the file as a whole is no good, if too many of its rows are bad; `file` is how the user calls it.
    pub(super) fn refusal(&self, file: &str) -> Option<(BadRow, String)> {
        let (&fault, first) = (self.kinds.seen().first()?, self.first.first()?.clone());
        (self.count * ONE_IN > self.rows).then(|| {
            let what = format!(
                "{} are bad, more than one in {ONE_IN}: mostly {} ({}), which looks like: {}; the first: {}; try `host-sim \
                 import {file} --out REC.csv`, or leave fields that are not known empty",
                self.of_rows(),
                fault.name(),
                group(self.of(fault) as i64),
                fault.likely_cause(),
                first.what
            );
            (first, what)
        })
    }

    fn of_rows(&self) -> String {
        format!("{} of {} rows", group(self.count as i64), group(self.rows as i64))
    }

    /// What a reader of the results must know, a sentence each.
    pub fn sentences(&self) -> Vec<String> {
        let rows = (self.count > 0).then(|| {
            let kinds: Vec<String> =
                self.kinds.seen().iter().map(|&fault| format!("{} {}", fault.name(), self.of(fault))).collect();
            let first = self.first.first().map(BadRow::to_string).unwrap_or_default();
            let rows = self.of_rows();
            format!("{rows} are bad input, carried through and not used ({}); the first: {first}.", kinds.join(", "))
        });
        let midnight = self.midnight_lines.first().map(|line| {
            let more = self.midnight_lines.len() - 1;
            let more = if more > 0 { format!(" and {more} more times after it") } else { String::new() };
            format!("The time of day begins anew at midnight in line {line}{more}: a day was added from there on.")
        });
        let still = self.standing_still.iter().map(|still| format!("{still}: is it connected, and the right column?"));
        rows.into_iter().chain(midnight).chain(still).collect()
    }
}
