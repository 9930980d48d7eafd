//! A recording or a log of the body, row by row; compensated here, where it is not.

use std::path::Path;

use towmag::{Pipeline, Settings};
use towmag_live::Sample;

use super::shown::Shown;
use crate::command::start_from;
use crate::error::HostError;
use crate::recording::{Column, Input, RecordingReader, RecordingRow};

/// Where a compensated field and its residual are: what `replay` writes, and what the body logs.
const COMPENSATED: [[&str; 2]; 2] =
    [["compensated_nT", "residual_nT"], ["logged_compensated_nT", "logged_residual_nT"]];

/// The rows of a recording.
pub(super) struct Recorded {
    reader: Box<dyn RecordingReader>,
    row: RecordingRow,
    compensation: Compensation,
}

enum Compensation {
    /// Compensated field and residual are in these columns.
    Columns(Vec<usize>),
    /// They are made here.
    Here(Box<Pipeline>),
}

impl Recorded {
    /// Open a recording; with coefficients it is compensated here in any case.
    pub(super) fn open(path: &Path, coefficients: Option<&Path>) -> Result<Self, HostError> {
        let reader = Input::new(path, false).ready()?.open()?;
        let columns = COMPENSATED.iter().find_map(|names| positions(&*reader, names));
        let compensation = match (coefficients, columns) {
            (None, Some(columns)) => Compensation::Columns(columns),
            (coefficients, _) => {
                let prior = start_from(coefficients)?.prior;
                Compensation::Here(Box::new(Pipeline::new(&Settings::default(), prior)?))
            }
        };
        Ok(Self { reader, row: RecordingRow::default(), compensation })
    }

    fn compensated(&mut self) -> [Option<f64>; 2] {
        match &mut self.compensation {
            Compensation::Here(pipeline) if self.row.is_on_grid => {
                let compensated = pipeline.step(&self.row.epoch).compensated;
                compensated.map_or([None; 2], |compensated| {
                    [Some(f64::from(compensated.compensated_pt) / 1e3), Some(compensated.residual_nt.into())]
                })
            }
            Compensation::Here(_) => [None; 2],
            Compensation::Columns(columns) => {
                let mut values = Vec::with_capacity(columns.len());
                let mut sink = |field: &[u8]| {
                    values.push(std::str::from_utf8(field).ok().and_then(|text| text.trim().parse().ok()));
                    Ok(())
                };
                // The sink never fails.
                _ = self.reader.write_fields(&self.row, columns, &mut sink);
                [0, 1].map(|place| values.get(place).copied().flatten())
            }
        }
    }

    fn shown(&mut self) -> Option<Shown> {
        let row_time_s = self.row.time_s()?;
        let [compensated_nt, residual_nt] = self.compensated();
        let row = &self.row;
        let utc_s = row.number(Column::Utc);
        let position = row.number(Column::Latitude).zip(row.number(Column::Longitude));
        let sample = Sample {
            time_s: utc_s.unwrap_or(row_time_s),
            sent_s: utc_s,
            heard_s: None,
            raw_nt: row.scalar_nt(),
            compensated_nt,
            residual_nt,
            depth_m: row.number(Column::Depth),
            altitude_m: row.number(Column::Altitude),
            position_deg: position.map(|(latitude, longitude)| [latitude, longitude]),
            has_leak: row.flag(Column::Leak),
            battery_v: row.number(Column::BatteryVoltage),
        };
        Some(Shown { sample, is_valid: row.is_usable(), notes: Vec::new() })
    }
}

fn positions(reader: &dyn RecordingReader, names: &[&str]) -> Option<Vec<usize>> {
    let position = |name: &&str| reader.schema().names().position(|column| column == name.as_bytes());
    names.iter().map(position).collect()
}

impl Iterator for Recorded {
    type Item = Result<Shown, HostError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.reader.read_row(&mut self.row) {
                Ok(false) => return None,
                Ok(true) => match self.shown() {
                    Some(shown) => return Some(Ok(shown)),
                    None => continue,
                },
                Err(error) => return Some(Err(error.into())),
            }
        }
    }
}
