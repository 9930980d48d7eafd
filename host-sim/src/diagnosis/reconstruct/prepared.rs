//! The columns of a recording as the diagnosis needs them: without rows of which the time is not known, without holes,
//! and the fluxgate only where it is to be trusted.

use crate::diagnosis::own_simulation::beyond::Beyond;
use crate::diagnosis::reconstruct::tangent_plane::sixth_difference;
use crate::effects::Request;
use crate::error::HostError;
use crate::recording::{self, BadRows, Column, CsvReader, EPOCH_S, Input, RecordingReader};
use crate::simulator::scenario::Simulation;

/// Valid rows that a diagnosis needs at least, s.
pub const LEAST_VALID_S: f64 = 60.0;

/// Share of the usable rows that may lack an optional value; above it the column counts as absent.
const MOST_MISSING: f64 = 0.1;

/// Columns that may drive something, beside depth, temperature, attitude and the currents of loads.
const OTHERS: [Column; 5] =
    [Column::ScalarSignal, Column::Altitude, Column::CableOut, Column::Speed, Column::BatteryVoltage];

/// How the body is tilted, by an attitude sensor.
pub(crate) const TILT: [(&str, Column); 2] = [("roll_deg", Column::Roll), ("pitch_deg", Column::Pitch)];

/// How much the magnitude of the fluxgate vector may differ from its usual one in a row that is not usable.
const SAME_MAGNITUDE: f64 = 0.01;

/// The columns of a recording, prepared. Rows without a time are left out; all columns have the same length.
#[derive(Clone, Debug, Default)]
pub struct Prepared {
    /// File as the user named it.
    pub file: String,
    /// On the recording's own axis, s.
    pub time_s: Vec<f64>,
    /// Scalar, nT; NaN where the row is not usable.
    pub scalar_nt: Vec<f64>,
    /// Fluxgate in body axes, nT; NaN where it was not read, and in a row that is not usable unless it goes on smoothly
    /// there: the scalar sensor's flag says nothing of the fluxgate, and a direction bridges what it knows better.
    pub flux_nt: Vec<[f64; 3]>,
    /// Whether the row may be used.
    pub usable: Vec<bool>,
    /// Depth, m, missing values interpolated.
    pub depth_m: Option<Vec<f64>>,
    /// Temperature at the fluxgate, degC, missing values interpolated.
    pub temperature_deg_c: Option<Vec<f64>>,
    /// Heading, degrees from true north by east.
    pub heading_deg: Option<Vec<f64>>,
    /// Roll and pitch, degrees, of those that were recorded, by the names of their columns.
    pub tilt_deg: Vec<(&'static str, Vec<f64>)>,
    /// Current of each load, A, missing values interpolated.
    pub currents_a: Vec<(String, Vec<f64>)>,
    /// Other columns of numbers, missing values interpolated.
    pub columns: Vec<(String, Vec<f64>)>,
    /// Smallest step with which each component of the fluxgate is written, nT.
    pub flux_resolution_nt: [f64; 3],
    /// Smallest step with which the scalar is written, nT.
    pub scalar_resolution_nt: f64,
    /// The rows that were no good.
    pub bad_rows: BadRows,
    /// What a simulation of the user's own says beyond the base model.
    pub(crate) beyond: Beyond,
}

impl Prepared {
    /// Read a whole recording, and refuse one with less than 60 s of valid rows.
    pub fn read(input: &Input) -> Result<Self, HostError> {
        Self::read_with(input, &[])
    }

    /// The same; of these names, those that are there are read too.
    pub fn read_with(input: &Input, names: &[String]) -> Result<Self, HostError> {
        let prepared = Self::from_reader(&mut *input.open()?, names)?;
        let valid_s = prepared.usable.iter().filter(|&&usable| usable).count() as f64 * EPOCH_S;
        if valid_s < LEAST_VALID_S {
            return Err(HostError::NotEnough(format!(
                "{}: {valid_s:.1} s of valid rows, a diagnosis needs at least {LEAST_VALID_S:.0} s",
                input.shown()
            )));
        }
        Ok(prepared)
    }

    /// Of the text of a CSV recording; errors call it `name`. Of these other columns, those that are there are read too.
    pub(crate) fn of_csv(name: &str, csv: &[u8], names: &[String]) -> Result<Self, HostError> {
        Self::from_reader(&mut CsvReader::from_reader(name, csv)?, names)
    }

    /// What a diagnosis reads of the recording that a simulation makes with some effects; errors call it `name`. Of these other
    /// columns, those that are there are read too.
    ///
    /// # Errors
    ///
    /// When it has no rows, or they are no recording.
    pub fn of_simulation(
        simulation: &Simulation,
        effects: &[Request],
        name: &str,
        names: &[String],
    ) -> Result<Self, HostError> {
        let mut csv = Vec::new();
        simulation.record(effects).write_csv(&mut csv)?;
        Self::of_csv(name, &csv, names)
    }

    fn from_reader(reader: &mut dyn RecordingReader, names: &[String]) -> Result<Self, HostError> {
        let names = with_beside(reader.schema(), names);
        Ok(Self::with(&recording::Table::read_with(reader, &names)?, &names))
    }

    /// Prepare the columns of a recording.
    pub fn of(table: &recording::Table) -> Self {
        Self::with(table, &[])
    }

    /// The same with other columns, of those of these names that are there.
    pub fn with(table: &recording::Table, names: &[String]) -> Self {
        let times_s = required(table, Column::Time);
        let rows: Vec<usize> = (0..table.len()).filter(|&row| !times_s[row].is_nan()).collect();
        let kept = |values: &[f64]| -> Vec<f64> { rows.iter().map(|&row| values[row]).collect() };
        let usable: Vec<bool> = rows.iter().map(|&row| table.usable()[row]).collect();
        let optional = |column: Column| filled(kept(table.numbers(column)?), &usable);
        let load = |(load, a): (&str, &[f64])| Some((load.to_string(), filled(kept(a), &usable)?));
        let other = |name: &String| Some((name.clone(), filled(kept(&table.numbers_named(name)?), &usable)?));
        let scalar_nt = kept(required(table, Column::Scalar)).into_iter().zip(&usable);
        Self {
            file: table.file().into(),
            time_s: kept(times_s),
            scalar_nt: scalar_nt.map(|(nt, &usable)| if usable { nt } else { f64::NAN }).collect(),
            flux_nt: flux_nt(table, &rows, &usable),
            depth_m: optional(Column::Depth),
            temperature_deg_c: optional(Column::Temperature),
            heading_deg: optional(Column::Heading),
            tilt_deg: TILT.into_iter().filter_map(|(name, column)| Some((name, optional(column)?))).collect(),
            currents_a: table.currents_a().filter_map(load).collect(),
            columns: names.iter().filter_map(other).collect(),
            flux_resolution_nt: Column::FLUX.map(|axis| resolution(table, axis)),
            scalar_resolution_nt: resolution(table, Column::Scalar),
            bad_rows: table.bad_rows().clone(),
            beyond: Beyond::default(),
            usable,
        }
    }

    /// The scalar less what a simulation of the user's own says of it beyond the base model, nT, one a row.
    pub(crate) fn to_explain_nt(&self) -> Vec<f64> {
        let mut left_nt = self.scalar_nt.clone();
        left_nt.iter_mut().zip(&self.beyond.scalar_nt).for_each(|(nt, simulated)| *nt -= simulated);
        left_nt
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Noise of the fluxgate's direction, rad rms of a component across it: by the sixth difference, which a body that
    /// rocks hardly has; by its median, which a shake now and then does not move.
    pub fn direction_noise_rad(&self) -> f64 {
        // Not a number where nothing was read, and so no difference there.
        let directions: Vec<[f64; 3]> = self.flux_nt.iter().map(|f| f.map(|nt| nt / magnitude(f))).collect();
        let sizes = directions.windows(7).map(|near| magnitude(&sixth_difference(near)));
        let mut sizes: Vec<f64> = sizes.filter(|size| size.is_finite()).collect();
        if sizes.is_empty() {
            return 0.0;
        }
        let middle = sizes.len() / 2;
        let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        // Two components: Rayleigh, whose median is 1.177 of each one's; the weights' squares add up to 924.
        median / 1.177_41 / 924_f64.sqrt()
    }

    /// Magnitude of the fluxgate vector, one a row, nT; not a number where nothing was read.
    pub(crate) fn magnitudes_nt(&self) -> Vec<f64> {
        self.flux_nt.iter().map(magnitude).collect()
    }

    /// Seconds since the first row.
    pub fn epochs_s(&self) -> Vec<f64> {
        let first_s = self.time_s.first().copied().unwrap_or(0.0);
        self.time_s.iter().map(|time_s| time_s - first_s).collect()
    }
}

/// Whether a column may drive something: neither sensors, nor attitude, nor time and place, nor what has a place of its own.
pub(crate) fn is_beside(name: &str) -> bool {
    Column::named(name).is_none_or(|column| OTHERS.contains(&column))
}

/// Some names, and those of all columns of a recording that may drive something, each once.
fn with_beside(schema: &recording::Schema, names: &[String]) -> Vec<String> {
    let mut all = names.to_vec();
    let there = schema.names().filter_map(|name| std::str::from_utf8(name).ok());
    for name in there.filter(|name| is_beside(name)) {
        if all.iter().all(|known| known != name) {
            all.push(name.into());
        }
    }
    all
}

fn required(table: &recording::Table, column: Column) -> &[f64] {
    table.numbers(column).expect("every recording has its required columns")
}

/// The vectors of some rows as far as they are to be trusted.
fn flux_nt(table: &recording::Table, rows: &[usize], usable: &[bool]) -> Vec<[f64; 3]> {
    let axes = Column::FLUX.map(|axis| required(table, axis));
    let vector = |&row: &usize| {
        let vector = axes.map(|axis| axis[row]);
        if vector.iter().any(|nt| nt.is_nan()) { [f64::NAN; 3] } else { vector }
    };
    let mut flux_nt: Vec<[f64; 3]> = rows.iter().map(vector).collect();
    trust_fluxgate(&mut flux_nt, usable);
    flux_nt
}

/// The smallest step that a column is written with; 1 where no usable row shows any.
fn resolution(table: &recording::Table, column: Column) -> f64 {
    table.resolution(column).unwrap_or(1.0)
}

/// A column without holes, or nothing when over a tenth of the usable rows lack a value.
fn filled(mut column: Vec<f64>, usable: &[bool]) -> Option<Vec<f64>> {
    let rows = usable.iter().filter(|&&usable| usable).count();
    let missing = column.iter().zip(usable).filter(|(value, usable)| **usable && value.is_nan()).count();
    if column.iter().all(|value| value.is_nan()) || missing as f64 > MOST_MISSING * rows as f64 {
        return None;
    }
    fill_holes(&mut column);
    Some(column)
}

fn magnitude(f: &[f64; 3]) -> f64 {
    (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt()
}

/// Take away what the fluxgate says in rows that are not usable, but where it goes on as in the usable ones: the same
/// magnitude, and no bend sharper than theirs.
fn trust_fluxgate(flux_nt: &mut [[f64; 3]], usable: &[bool]) {
    let mut magnitudes: Vec<f64> =
        flux_nt.iter().zip(usable).filter(|(_, used)| **used).map(|(f, _)| magnitude(f)).collect();
    if magnitudes.is_empty() {
        return;
    }
    let middle = magnitudes.len() / 2;
    let usual_nt = *magnitudes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let bend = |k: usize| {
        let [a, b, c] = [flux_nt[k - 1], flux_nt[k], flux_nt[k + 1]];
        magnitude(&[0, 1, 2].map(|i| a[i] - 2.0 * b[i] + c[i]))
    };
    let last = flux_nt.len().saturating_sub(1);
    let sharpest_nt = (1..last).filter(|&k| usable[k - 1] && usable[k] && usable[k + 1]).map(bend).fold(0.0, f64::max);
    let mut trusted = usable.to_vec();
    let mut from = 0;
    while from <= last {
        if usable[from] {
            from += 1;
            continue;
        }
        let to = (from..=last).find(|&k| usable[k]).unwrap_or(last + 1);
        let is_usual = flux_nt[from..to].iter().all(|f| (magnitude(f) / usual_nt - 1.0).abs() < SAME_MAGNITUDE);
        let is_smooth = (from.max(2) - 1..(to + 1).min(last)).all(|k| bend(k) <= sharpest_nt);
        trusted[from..to].fill(is_usual && is_smooth);
        from = to;
    }
    flux_nt.iter_mut().zip(trusted).filter(|(_, trusted)| !trusted).for_each(|(flux, _)| *flux = [f64::NAN; 3]);
}

/// Put straight lines across what is not a number, and the nearest value before the first and after the last one.
pub(crate) fn fill_holes(column: &mut [f64]) {
    let mut last: Option<usize> = None;
    for at in 0..column.len() {
        if !column[at].is_finite() {
            continue;
        }
        let value = column[at];
        let (from, start) = last.map_or((0, value), |last| (last + 1, column[last]));
        let projection = (at + 1 - from) as f64;
        for (k, hole) in column[from..at].iter_mut().enumerate() {
            *hole = start + (value - start) * (k + 1) as f64 / projection;
        }
        last = Some(at);
    }
    if let Some(last) = last {
        let value = column[last];
        column[last + 1..].fill(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_bridged_by_straight_lines() {
        let mut column = [f64::NAN, 1.0, f64::NAN, f64::NAN, 4.0, f64::NAN];
        fill_holes(&mut column);
        assert_eq!(column, [1.0, 1.0, 2.0, 3.0, 4.0, 4.0]);
    }

    #[test]
    fn the_fluxgate_is_trusted_in_a_flagged_row_only_where_it_goes_on() {
        let smooth = |k: usize| [30_000.0 * (0.02 * k as f64).cos(), 30_000.0 * (0.02 * k as f64).sin(), 40_000.0];
        let mut flux_nt: Vec<[f64; 3]> = (0..100).map(smooth).collect();
        let usable: Vec<bool> = (0..100).map(|k| !(20..30).contains(&k) && !(50..60).contains(&k)).collect();
        flux_nt[55] = flux_nt[49];
        trust_fluxgate(&mut flux_nt, &usable);
        assert!((20..30).all(|k| flux_nt[k] == smooth(k)));
        assert!((50..60).all(|k| flux_nt[k][0].is_nan()));
        assert!((60..100).all(|k| flux_nt[k] == smooth(k)));
    }
}
