//! `compensated.csv`: the recording as it was, and what the core made of each row.

use std::io::Write;

use csv::ByteRecord;
use towmag::estimate::Quality;
use towmag::{Compensated, Output};

use crate::recording::RecordingRow;
use crate::run::difference_nt;

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
    kept: Vec<usize>,
}

impl<W: Write> CompensatedCsv<W> {
    /// Write the header: the recording's own columns, save those of an earlier compensation, and the added ones.
    pub(crate) fn new(writer: W, header: &ByteRecord) -> csv::Result<Self> {
        let is_added = |name: &[u8]| ADDED.iter().any(|added| added.as_bytes() == name);
        let kept = (0..header.len()).filter(|&i| !is_added(&header[i])).collect();
        let mut csv = Self { writer: csv::Writer::from_writer(writer), kept };
        csv.write_kept(header)?;
        csv.writer.write_record(ADDED)?;
        Ok(csv)
    }

    /// Write one row. Where the core rejected it, the added fields are empty and `valid` is 0.
    pub(crate) fn write(&mut self, row: &RecordingRow, output: &Output) -> csv::Result<()> {
        self.write_with(row, output, None)
    }

    /// The same with what the method says of its output.
    pub(crate) fn write_with(
        &mut self,
        row: &RecordingRow,
        output: &Output,
        quality: Option<&Quality>,
    ) -> csv::Result<()> {
        self.write_kept(&row.fields)?;
        match (row.scalar_nt, output.compensated) {
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

    fn write_kept(&mut self, fields: &ByteRecord) -> csv::Result<()> {
        self.kept.iter().try_for_each(|&i| self.writer.write_field(&fields[i]))
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
