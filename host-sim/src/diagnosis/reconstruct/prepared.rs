//! A recording as whole columns, as the diagnosis needs it.

use std::path::Path;

use crate::diagnosis::reconstruct::tangent_plane::sixth_difference;
use crate::error::HostError;
use crate::recording::{self, LoadColumn, RecordingRow, Rows};

/// Valid rows that a diagnosis needs at least, s.
pub const LEAST_VALID_S: f64 = 60.0;

/// Seconds per row.
const EPOCH_S: f64 = 0.1;

/// Share of the usable rows that may lack an optional value; above it the column counts as absent.
const MOST_MISSING: f64 = 0.1;

/// How much the magnitude of the fluxgate vector may differ from its usual one in a row that is not usable.
const SAME_MAGNITUDE: f64 = 0.01;

/// A recording in memory. Rows without a time are left out; all columns have the same length.
#[derive(Clone, Debug, Default)]
pub struct Table {
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
    /// Current of each load, A, missing values interpolated.
    pub currents_a: Vec<(String, Vec<f64>)>,
    /// Resolution with which the fluxgate is written, nT: one of its last decimal.
    pub flux_resolution_nt: f64,
    /// Resolution with which the scalar is written, nT.
    pub scalar_resolution_nt: f64,
}

/// Optional columns while they are read.
#[derive(Default)]
struct Optional {
    depth_m: Vec<Option<f64>>,
    temperature_deg_c: Vec<Option<f64>>,
    heading_deg: Vec<Option<f64>>,
    currents_a: Vec<Vec<Option<f64>>>,
}

impl Table {
    /// Read a whole recording, and refuse one with less than 60 s of valid rows.
    pub fn read(path: &Path) -> Result<Self, HostError> {
        let mut rows = recording::open(path)?;
        let table = Self::of(&mut *rows)?;
        let valid_s = table.usable.iter().filter(|&&usable| usable).count() as f64 * EPOCH_S;
        if valid_s < LEAST_VALID_S {
            return Err(HostError::NotEnough(format!(
                "{}: {valid_s:.1} s of valid rows, a diagnosis needs at least {LEAST_VALID_S:.0} s",
                path.display()
            )));
        }
        Ok(table)
    }

    /// Everything that a reader still has.
    pub fn of(rows: &mut dyn Rows) -> Result<Self, HostError> {
        let columns = rows.columns().clone();
        let mut table = Self { file: rows.file().to_string(), ..Self::default() };
        let mut optional = Optional { currents_a: vec![Vec::new(); columns.currents.len()], ..Optional::default() };
        let (mut row, mut decimals) = (RecordingRow::default(), [0; 2]);
        while rows.read_row(&mut row)? {
            let Some(time_s) = row.time_s else { continue };
            table.push(time_s, &row);
            optional.push(&row);
            if row.is_usable() {
                let of = |index: usize| decimals_of(row.fields.get(index).unwrap_or_default());
                decimals[0] = decimals[0].max(of(columns.scalar_nt));
                decimals[1] = columns.flux_nt.iter().fold(decimals[1], |most, &index| most.max(of(index)));
            }
        }
        [table.scalar_resolution_nt, table.flux_resolution_nt] = decimals.map(|places| 0.1_f64.powi(places));
        table.take(optional, &columns.currents);
        trust_fluxgate(&mut table.flux_nt, &table.usable);
        Ok(table)
    }

    fn push(&mut self, time_s: f64, row: &RecordingRow) {
        let usable = row.is_usable();
        self.time_s.push(time_s);
        self.usable.push(usable);
        self.scalar_nt.push(row.scalar_nt.filter(|_| usable).unwrap_or(f64::NAN));
        self.flux_nt.push(row.flux_nt.unwrap_or([f64::NAN; 3]));
    }

    fn take(&mut self, optional: Optional, loads: &[LoadColumn]) {
        self.depth_m = filled(&optional.depth_m, &self.usable);
        self.temperature_deg_c = filled(&optional.temperature_deg_c, &self.usable);
        self.heading_deg = filled(&optional.heading_deg, &self.usable);
        for (load, current) in loads.iter().zip(&optional.currents_a) {
            if let Some(current) = filled(current, &self.usable) {
                self.currents_a.push((load.load.clone(), current));
            }
        }
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

    /// Seconds since the first row.
    pub fn epochs_s(&self) -> Vec<f64> {
        let first_s = self.time_s.first().copied().unwrap_or(0.0);
        self.time_s.iter().map(|time_s| time_s - first_s).collect()
    }
}

impl Optional {
    fn push(&mut self, row: &RecordingRow) {
        self.depth_m.push(row.depth_m);
        self.temperature_deg_c.push(row.temperature_deg_c);
        self.heading_deg.push(row.heading_deg);
        for (column, &value) in self.currents_a.iter_mut().zip(&row.currents_a) {
            column.push(value);
        }
    }
}

/// A column without holes, or nothing when over a tenth of the usable rows lack a value.
fn filled(values: &[Option<f64>], usable: &[bool]) -> Option<Vec<f64>> {
    let rows = usable.iter().filter(|&&usable| usable).count();
    let missing = values.iter().zip(usable).filter(|(value, usable)| **usable && value.is_none()).count();
    if values.iter().flatten().next().is_none() || missing as f64 > MOST_MISSING * rows as f64 {
        return None;
    }
    let mut column: Vec<f64> = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
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

/// Digits after the point, as far as they mean something: shortest text of an `f64` has up to 17.
fn decimals_of(field: &[u8]) -> i32 {
    let field = field.trim_ascii();
    if field.iter().any(|byte| matches!(byte, b'e' | b'E')) {
        return 9;
    }
    let after = field.iter().rev().position(|&byte| byte == b'.');
    after.map_or(0, |count| count.min(9) as i32)
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

    #[test]
    fn decimals_are_those_of_the_text() {
        let of = |text: &str| decimals_of(text.as_bytes());
        assert_eq!([of("50000"), of("50000.10 "), of("-0.125"), of("5e4")], [0, 2, 3, 9]);
    }
}
