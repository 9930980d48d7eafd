//! What a pass counts.

use crate::recording::{BadRows, Column, RecordingRow, SessionGap, utc_offset_s};

/// What a pass counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Rows read.
    pub rows: u64,
    /// Rows compensated; the figures are of these.
    pub used_rows: u64,
    /// Gaps longer than an epoch.
    pub gaps: u64,
    /// Time lost in gaps, s.
    pub gap_s: f64,
    /// Time of the first and of the last row that has one, s.
    pub span_s: Option<(f64, f64)>,
    /// What makes seconds since 1970 of the times, where the recording tells it.
    pub utc_offset_s: Option<f64>,
    /// Whether the recording holds a heading of its own.
    pub recorded_heading: bool,
    /// Rows that were no good.
    pub bad_rows: BadRows,
    /// What lies between the sessions of a log.
    pub session_gaps: Vec<SessionGap>,
}

impl Counts {
    /// Count a row, whatever becomes of it.
    pub fn count(&mut self, row: &RecordingRow) {
        self.rows += 1;
        if let Some(gap_s) = row.gap_s {
            self.gaps += 1;
            self.gap_s += gap_s;
        }
        if let Some(time_s) = row.time_s() {
            if self.utc_offset_s.is_none() {
                let utc_s = row.number(Column::Utc);
                self.utc_offset_s = utc_offset_s(&[time_s], utc_s.as_ref().map(std::slice::from_ref));
            }
            self.span_s = Some((self.span_s.map_or(time_s, |(first, _)| first), time_s));
        }
    }
}
