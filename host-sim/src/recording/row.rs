//! One row: its values, and what the contract says of them.

use super::bad_rows::RowFault;
use super::error::BadInput;
use super::ticks::{Tick, TickCounter};
use crate::message::number;
use towmag::Epoch;
use towmag_recording::{Column, FIELD_RANGE_NT};

/// One row of a recording. Made once and filled again for every row, so that reading allocates nothing.
#[derive(Clone, Debug)]
pub struct RecordingRow {
    /// Where the row is: in a file of text the physical line on which it starts, from 1.
    pub line_number: u64,
    /// One value a known column, if it is there; a flag is 1 or 0.
    values: [Option<f64>; Column::COUNT],
    /// `current_<load>_A`, in the order of [`Schema::loads`](super::Schema::loads).
    pub currents_a: Vec<Option<f64>>,
    /// The label `line` as it is in the recording; empty when it is missing.
    pub line: String,
    /// Seconds since the last row with a time, when epochs are missing in between.
    pub gap_s: Option<f64>,
    /// Whether the row has a place on the grid of epochs. One whose time is wrong has none, and the core never sees it.
    pub is_on_grid: bool,
    /// What the core sees of the row. Its scalar is there exactly when the row is [usable](Self::is_usable).
    pub epoch: Epoch,
}

impl Default for RecordingRow {
    fn default() -> Self {
        Self {
            line_number: 0,
            values: [None; Column::COUNT],
            currents_a: Vec::new(),
            line: String::new(),
            gap_s: None,
            is_on_grid: true,
            epoch: Epoch { tick: 0, scalar_pt: None, flux_nt: None },
        }
    }
}

impl RecordingRow {
    /// Forget all values, before those of the next row are set.
    pub fn clear(&mut self) {
        self.values = [None; Column::COUNT];
        self.currents_a.clear();
        self.line.clear();
    }

    /// Set the value of a column of numbers or flags: finite, a flag 1 or 0.
    pub fn set(&mut self, column: Column, value: Option<f64>) {
        self.values[column as usize] = value;
    }

    /// The value of a column of numbers.
    pub fn number(&self, column: Column) -> Option<f64> {
        self.values[column as usize]
    }

    /// The value of a column of flags.
    pub fn flag(&self, column: Column) -> Option<bool> {
        self.number(column).map(|value| value != 0.0)
    }

    /// `time_s`.
    pub fn time_s(&self) -> Option<f64> {
        self.number(Column::Time)
    }

    /// `scalar_nT`, also when it is flagged as invalid.
    pub fn scalar_nt(&self) -> Option<f64> {
        self.number(Column::Scalar)
    }

    /// `scalar_valid`; true when the column or the value is missing.
    pub fn is_scalar_valid(&self) -> bool {
        self.flag(Column::ScalarValid).unwrap_or(true)
    }

    /// `flux_x_nT`, `flux_y_nT`, `flux_z_nT`; `None` when one of them is missing.
    pub fn flux_nt(&self) -> Option<[f64; 3]> {
        match Column::FLUX.map(|axis| self.number(axis)) {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    /// Whether the row may be used for adaptation and diagnosis: all required values are there and
    /// the scalar sensor does not flag its own as invalid. All others are only carried through.
    pub fn is_usable(&self) -> bool {
        self.epoch.scalar_pt.is_some()
    }

    /// After all values have been set: hold them against the contract, and set what the core sees of the row, its tick
    /// and the gap before it.
    ///
    /// # Errors
    ///
    /// When a reading of a usable row is none that the Earth has, or the time does not come after the one before.
    pub fn complete(&mut self, ticks: &mut TickCounter) -> Result<(), BadInput> {
        self.set_readings()?;
        let tick = ticks.step(self.time_s())?;
        self.place(tick);
        Ok(())
    }

    /// The same where a row that is no good is carried through instead: it is not usable, and has no place on the grid if
    /// its time is wrong. What is wrong with it first.
    pub fn complete_or_spoil(&mut self, ticks: &mut TickCounter) -> Option<BadInput> {
        let reading = self.set_readings().err();
        let time = match ticks.step(self.time_s()) {
            Ok(tick) => {
                self.place(tick);
                None
            }
            Err(bad) => {
                self.spoil(ticks);
                Some(bad)
            }
        };
        reading.or(time)
    }

    /// The time is wrong: the row goes without one, and without a place on the grid.
    pub fn spoil(&mut self, ticks: &mut TickCounter) {
        self.epoch.flux_nt = None;
        self.place(ticks.pass_over());
        self.set(Column::Time, None);
        self.epoch.scalar_pt = None;
        self.is_on_grid = false;
    }

    fn place(&mut self, tick: Tick) {
        self.epoch.tick = tick.tick;
        self.gap_s = tick.gap_s;
        self.is_on_grid = true;
    }

    /// The core's view of the readings. Their range is of interest only in a row that is used.
    fn set_readings(&mut self) -> Result<(), BadInput> {
        let flux_nt = self.flux_nt();
        self.epoch.flux_nt = flux_nt.map(|flux_nt| flux_nt.map(|component| component as f32));
        self.epoch.scalar_pt = None;
        if let (Some(_), Some(scalar_nt), Some([x, y, z]), true) =
            (self.time_s(), self.scalar_nt(), flux_nt, self.is_scalar_valid())
        {
            in_range(b"scalar_nT", "", scalar_nt)?;
            in_range(b"flux_x_nT, flux_y_nT, flux_z_nT", "magnitude ", (x * x + y * y + z * z).sqrt())?;
            self.epoch.scalar_pt = Some((scalar_nt * 1000.0).round() as i32);
        }
        Ok(())
    }
}

fn in_range(columns: &[u8], what: &str, value_nt: f64) -> Result<(), BadInput> {
    if FIELD_RANGE_NT.contains(&value_nt) {
        return Ok(());
    }
    let value = number(value_nt);
    Err(BadInput::of(columns, format!("{what}{value} nT is outside 1000 to 100000 nT")).in_row(RowFault::OutOfRange))
}
