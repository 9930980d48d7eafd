//! `compensated.csv`: the recording as it was, and what the core made of each row.

use std::io::Write;

use towmag::Compensated;
use towmag::estimate::Quality;

use crate::recording::Schema;
use crate::run::{PassedRow, difference_nt};

/// The columns that are added, in this order. The last three only the adaptive method fills.
const ADDED: [&str; 8] = [
    "interference_nT",
    "compensated_nT",
    "residual_nT",
    "residual_after_update_nT",
    "valid",
    "predicted_std_nT",
    "adapted_share",
    "adaptation",
];

/// Writes row after row.
pub(crate) struct CompensatedCsv<W: Write> {
    writer: csv::Writer<W>,
    /// Positions of the recording's own columns that are passed through.
    kept: Vec<usize>,
}

impl<W: Write> CompensatedCsv<W> {
    /// Write the header: the recording's own columns, save those of an earlier compensation, and the added ones.
    pub(crate) fn new(writer: W, schema: &Schema) -> csv::Result<Self> {
        let is_added = |name: &[u8]| ADDED.iter().any(|added| added.as_bytes() == name);
        let kept: Vec<usize> = (0..schema.len()).filter(|&position| !is_added(schema.name(position))).collect();
        let mut writer = csv::Writer::from_writer(writer);
        kept.iter().try_for_each(|&position| writer.write_field(schema.name(position)))?;
        writer.write_record(ADDED)?;
        Ok(Self { writer, kept })
    }

    /// Write one row. Where the core rejected it, the added fields are empty and `valid` is 0.
    pub(crate) fn write(&mut self, passed: &PassedRow<'_>) -> csv::Result<()> {
        let PassedRow { recording, row, output, quality } = *passed;
        let writer = &mut self.writer;
        recording.write_fields(row, &self.kept, &mut |field| writer.write_field(field))?;
        match (row.scalar_nt(), output.compensated) {
            (Some(scalar_nt), Some(compensated)) => self.write_added(scalar_nt, &compensated)?,
            _ => ["", "", "", "", "0"].iter().try_for_each(|field| self.writer.write_field(field))?,
        }
        self.write_quality(quality)
    }

    fn write_quality(&mut self, quality: Option<&Quality>) -> csv::Result<()> {
        let Some(Quality { predicted_std_nt, adapted, adaptation }) = quality else {
            return self.writer.write_record(["", "", ""]);
        };
        let mut digits = zmij::Buffer::new();
        self.writer.write_field(digits.format(*predicted_std_nt))?;
        self.writer.write_field(digits.format(*adapted))?;
        self.writer.write_record([adaptation.name()])
    }

    /// Each `f32` in the fewest digits that give the same bits back. The compensated field is the difference of the
    /// numbers as they are written, so that whoever subtracts them gets the same.
    fn write_added(&mut self, scalar_nt: f64, compensated: &Compensated) -> csv::Result<()> {
        let mut digits = zmij::Buffer::new();
        let interference = digits.format(compensated.interference_nt);
        self.writer.write_field(interference)?;
        let written_nt: f64 = interference.parse().unwrap_or(f64::NAN);
        self.writer.write_field(digits.format(difference_nt(scalar_nt, written_nt)))?;
        self.writer.write_field(digits.format(compensated.residual_nt))?;
        self.writer.write_field(digits.format(compensated.residual_after_update_nt))?;
        self.writer.write_field("1")
    }

    /// Flush what is left; the writer back.
    pub(crate) fn finish(self) -> Result<W, csv::Error> {
        self.writer.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))
    }
}
