//! Reading past rows that are no good: each is carried through as one that is never used, and counted.

use std::io::Read;

use super::clock::{Clock, Judged};
use super::fields::{Fields, decimals_of, finite};
use super::records::Records;
use crate::recording::bad_rows::{BadRow, BadRows, RowFault};
use crate::recording::error::BadInput;
use crate::recording::row::RecordingRow;
use crate::recording::schema::Schema;
use crate::recording::ticks::TickCounter;
use towmag_recording::Column;

/// What was read past so far.
#[derive(Default)]
pub(super) struct Tolerance {
    bad_rows: BadRows,
    clock: Clock,
    /// Fewest digits behind the point that the last field of a row had.
    fewest_decimals: Option<usize>,
}

impl Tolerance {
    pub(super) fn bad_rows(&self) -> &BadRows {
        &self.bad_rows
    }

    /// Set `row` from the latest record.
    pub(super) fn read<R: Read>(
        &mut self,
        records: &mut Records<R>,
        schema: &Schema,
        ticks: &mut TickCounter,
        row: &mut RecordingRow,
    ) {
        self.bad_rows.count_row();
        let length = self.wrong_length(records, schema);
        let fields = Fields { record: records.fields(), schema };
        let values = match length {
            // Which of its fields are where they should be, nobody knows.
            Some(bad) => {
                fields.set_unused(row);
                row.set(Column::Time, None);
                Some(bad)
            }
            None => fields.set_values(row).err().inspect(|_| fields.set_unused(row)),
        };
        let time = self.place(records, schema, ticks, row);
        if let Some(BadInput { fault: Some(fault), column, what }) = values.or(time) {
            self.bad_rows.add(fault, BadRow { line: row.line_number, column, what });
        }
    }

    /// Readings, time and tick of a row whose values are set. What is wrong with them.
    fn place<R: Read>(
        &mut self,
        records: &mut Records<R>,
        schema: &Schema,
        ticks: &mut TickCounter,
        row: &mut RecordingRow,
    ) -> Option<BadInput> {
        let [time, ..] = schema.required();
        let next = || records.peek().and_then(|next| next.get(time)).and_then(finite);
        match row.time_s().map(|written_s| self.clock.judge(written_s, ticks.latest_s(), next)) {
            None => {}
            Some(Judged::Time(time_s)) => row.set(Column::Time, Some(time_s)),
            Some(Judged::Midnight(time_s)) => {
                row.set(Column::Time, Some(time_s));
                self.bad_rows.midnight_lines.push(row.line_number);
            }
            Some(Judged::Wrong(bad)) => {
                row.spoil(ticks);
                return Some(bad);
            }
        }
        row.complete_or_spoil(ticks)
    }

    /// A row with more or fewer fields than the header, or the last one when it is cut in its last field: it has no line end,
    /// and its last number fewer digits behind the point than that of any row before.
    fn wrong_length<R: Read>(&mut self, records: &mut Records<R>, schema: &Schema) -> Option<BadInput> {
        let (fields, columns) = (records.fields().len(), schema.len());
        if fields != columns {
            let what = format!("has {fields} fields where the header has {columns}");
            let is_cut = fields < columns && records.peek().is_none();
            let fault = if is_cut { RowFault::TruncatedLine } else { RowFault::FieldCount };
            return Some(BadInput::of_line(what).in_row(fault));
        }
        let last = records.fields().iter().next_back().unwrap_or_default().trim_ascii();
        let decimals = if last.is_empty() { return None } else { decimals_of(last) };
        let is_short = self.fewest_decimals.is_some_and(|fewest| decimals < fewest);
        self.fewest_decimals = Some(self.fewest_decimals.map_or(decimals, |fewest| fewest.min(decimals)));
        if is_short && !records.is_line_ended() && records.peek().is_none() {
            let what = "has no line end, and fewer digits in its last field than any row before: it is cut";
            return Some(BadInput::of_line(what).in_row(RowFault::TruncatedLine));
        }
        None
    }
}
