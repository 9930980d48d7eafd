//! One row: the original text, its values, and what counts as bad input.

use super::columns::Columns;
use super::error::Fault;
use crate::message::{number, quoted};
use csv::ByteRecord;
use towmag::Epoch;

/// What the total field can be on Earth, with room to spare, nT.
const RANGE_NT: std::ops::RangeInclusive<f64> = 1_000.0..=100_000.0;

/// One row of a recording. Made once and filled again for every row, so that reading allocates nothing.
#[derive(Clone, Debug)]
pub struct RecordingRow {
    /// The row as it is in the file, for passing it through.
    pub fields: ByteRecord,
    /// Physical line in the file on which the row starts, from 1.
    pub line_number: u64,
    /// `time_s`.
    pub time_s: Option<f64>,
    /// `scalar_nT`, also when it is flagged as invalid.
    pub scalar_nt: Option<f64>,
    /// `flux_x_nT`, `flux_y_nT`, `flux_z_nT`; `None` when one of them is missing.
    pub flux_nt: Option<[f64; 3]>,
    /// `scalar_valid`; true when the column or the value is missing.
    pub scalar_valid: bool,
    /// `scalar_signal`, as the sensor reports it.
    pub scalar_signal: Option<f64>,
    /// `depth_m`.
    pub depth_m: Option<f64>,
    /// `temperature_degC`.
    pub temperature_deg_c: Option<f64>,
    /// `roll_deg`, starboard down.
    pub roll_deg: Option<f64>,
    /// `pitch_deg`, nose up.
    pub pitch_deg: Option<f64>,
    /// `heading_deg`, from true north by east.
    pub heading_deg: Option<f64>,
    /// `latitude_deg`, WGS 84.
    pub latitude_deg: Option<f64>,
    /// `longitude_deg`, WGS 84.
    pub longitude_deg: Option<f64>,
    /// `current_<load>_A`, in the order of [`Columns::currents`].
    pub currents_a: Vec<Option<f64>>,
    /// Seconds since the last row with a time, when epochs are missing in between.
    pub gap_s: Option<f64>,
    /// What the core sees of the row. Its scalar is there exactly when the row is [usable](Self::is_usable).
    pub epoch: Epoch,
}

impl Default for RecordingRow {
    fn default() -> Self {
        Self {
            fields: ByteRecord::new(),
            line_number: 0,
            time_s: None,
            scalar_nt: None,
            flux_nt: None,
            scalar_valid: true,
            scalar_signal: None,
            depth_m: None,
            temperature_deg_c: None,
            roll_deg: None,
            pitch_deg: None,
            heading_deg: None,
            latitude_deg: None,
            longitude_deg: None,
            currents_a: Vec::new(),
            gap_s: None,
            epoch: Epoch { tick: 0, scalar_pt: None, flux_nt: None },
        }
    }
}

impl RecordingRow {
    /// Whether the row may be used for adaptation and diagnosis: all required values are there and
    /// the scalar sensor does not flag its own as invalid. All others are only carried through.
    pub fn is_usable(&self) -> bool {
        self.epoch.scalar_pt.is_some()
    }

    /// Set all values but the tick and the gap from `fields`.
    pub(super) fn parse(&mut self, columns: &Columns, header: &ByteRecord) -> Result<(), Fault> {
        let [time, scalar, x, y, z] = columns.required();
        let complete = columns.required().iter().all(|&index| !trimmed(&self.fields, index).is_empty());
        let flag = columns.scalar_valid.map_or(Ok(true), |index| flag(&self.fields, index));
        self.scalar_valid = match flag {
            Err(fault) if complete => return Err(fault),
            flag => flag.unwrap_or(false),
        };
        // A row that is never used may hold whatever it likes: what is no number counts as missing.
        let usable = complete && self.scalar_valid;
        let values = Values { fields: &self.fields, header, strict: usable };
        self.time_s = values.get(time)?;
        self.scalar_nt = values.get(scalar)?;
        self.flux_nt = match (values.get(x)?, values.get(y)?, values.get(z)?) {
            (Some(x), Some(y), Some(z)) => Some([x, y, z]),
            _ => None,
        };
        self.scalar_signal = values.optional(columns.scalar_signal)?;
        self.depth_m = values.optional(columns.depth_m)?;
        self.temperature_deg_c = values.optional(columns.temperature_deg_c)?;
        self.roll_deg = values.optional(columns.roll_deg)?;
        self.pitch_deg = values.optional(columns.pitch_deg)?;
        self.heading_deg = values.optional(columns.heading_deg)?;
        self.latitude_deg = values.optional(columns.latitude_deg)?;
        self.longitude_deg = values.optional(columns.longitude_deg)?;
        self.currents_a.clear();
        for column in &columns.currents {
            self.currents_a.push(values.get(column.index)?);
        }
        self.set_readings(usable)
    }

    /// The core's view of the readings. Their range is of interest only in a row that is used.
    fn set_readings(&mut self, usable: bool) -> Result<(), Fault> {
        self.epoch.flux_nt = self.flux_nt.map(|flux_nt| flux_nt.map(|component| component as f32));
        self.epoch.scalar_pt = None;
        if let (true, Some(scalar_nt), Some([x, y, z])) = (usable, self.scalar_nt, self.flux_nt) {
            in_range(b"scalar_nT", "", scalar_nt)?;
            in_range(b"flux_x_nT, flux_y_nT, flux_z_nT", "magnitude ", (x * x + y * y + z * z).sqrt())?;
            self.epoch.scalar_pt = Some((scalar_nt * 1000.0).round() as i32);
        }
        Ok(())
    }
}

/// The numbers of one row.
struct Values<'a> {
    fields: &'a ByteRecord,
    header: &'a ByteRecord,
    /// Whether what is no number is bad input, or as good as missing.
    strict: bool,
}

impl Values<'_> {
    fn get(&self, index: usize) -> Result<Option<f64>, Fault> {
        let field = trimmed(self.fields, index);
        if field.is_empty() {
            return Ok(None);
        }
        match parse(field) {
            Some(value) if value.is_finite() => Ok(Some(value)),
            _ if !self.strict => Ok(None),
            value => Err(self.no_number(index, field, value)),
        }
    }

    fn optional(&self, index: Option<usize>) -> Result<Option<f64>, Fault> {
        index.map_or(Ok(None), |index| self.get(index))
    }

    #[cold]
    fn no_number(&self, index: usize, field: &[u8], value: Option<f64>) -> Fault {
        let finite = if value.is_some() { "finite " } else { "" };
        Fault::of(&self.header[index], format!("{} is not a {finite}number", quoted(field)))
    }
}

fn trimmed(fields: &ByteRecord, index: usize) -> &[u8] {
    fields.get(index).unwrap_or_default().trim_ascii()
}

fn parse(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// A missing flag is as good as none at all: the reading counts as valid.
fn flag(fields: &ByteRecord, index: usize) -> Result<bool, Fault> {
    let field = trimmed(fields, index);
    match field {
        b"" | b"1" => return Ok(true),
        b"0" => return Ok(false),
        _ => {}
    }
    match parse(field) {
        Some(1.0) => Ok(true),
        Some(0.0) => Ok(false),
        _ => Err(Fault::of(b"scalar_valid", format!("{} is neither 1 nor 0", quoted(field)))),
    }
}

fn in_range(columns: &[u8], what: &str, value_nt: f64) -> Result<(), Fault> {
    if RANGE_NT.contains(&value_nt) {
        return Ok(());
    }
    let value = number(value_nt);
    Err(Fault::of(columns, format!("{what}{value} nT is outside 1000 to 100000 nT")))
}
