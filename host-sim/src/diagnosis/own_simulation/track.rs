//! A simulation of a user's own: its columns at any rate, and their values between its rows.

use std::path::Path;

use crate::diagnosis::numerics::{lagrange, median};
use crate::error::HostError;
use crate::message::{quoted, shortened};

/// Columns that a simulation must have.
const COLUMNS: [&str; 5] = ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];
/// Rows that an interpolation looks at: a sine of 1 Hz is met to 3e-6 of its amplitude at 10 Hz, one of 2 Hz to 2e-3.
const NODES: usize = 10;
/// A step longer than this many usual ones is a gap, across which nothing is known.
const LONGEST_STEP: f64 = 1.5;
/// Rows of a simulation at least.
const LEAST_ROWS: usize = 100;

/// What a simulation says, one value a row.
#[derive(Clone, Debug, Default)]
pub struct SimulatedTrack {
    /// File as the user named it.
    pub file: String,
    /// On its own axis, s, strictly increasing.
    pub time_s: Vec<f64>,
    /// Scalar, nT.
    pub scalar_nt: Vec<f64>,
    /// Fluxgate in body axes, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

impl SimulatedTrack {
    /// Read a CSV file with `time_s`, `scalar_nT` and the three of the fluxgate, at any rate; further columns are left aside.
    ///
    /// # Errors
    ///
    /// When it cannot be read, lacks a column, has a value that is no number or a time that goes back; with file and line.
    pub fn read(path: &Path) -> Result<Self, HostError> {
        let name = path.display().to_string();
        let file = std::fs::File::open(path).map_err(|error| HostError::Usage(format!("{name}: {error}")))?;
        Self::from_reader(&name, file)
    }

    /// The same from anywhere; errors call it `name`.
    pub fn from_reader(name: &str, from: impl std::io::Read) -> Result<Self, HostError> {
        let wrong = |line: u64, what: String| HostError::Usage(format!("{name}:{line}: {what}"));
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(from);
        let headers = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
        let places = places(&headers).map_err(|what| wrong(1, what))?;
        let mut track = Self { file: name.into(), ..Self::default() };
        for (row, record) in reader.records().enumerate() {
            let line = row as u64 + 2;
            let record = record.map_err(|error| wrong(line, error.to_string()))?;
            track.push(&record, places).map_err(|what| wrong(line, what))?;
        }
        match track.time_s.len() < LEAST_ROWS {
            true => Err(HostError::NotEnough(format!("{name}: a simulation needs at least {LEAST_ROWS} rows"))),
            false => Ok(track),
        }
    }

    /// One row more, of columns at these places.
    fn push(&mut self, record: &csv::StringRecord, places: [usize; COLUMNS.len()]) -> Result<(), String> {
        let mut values = [0.0; COLUMNS.len()];
        for ((value, place), name) in values.iter_mut().zip(places).zip(COLUMNS) {
            let text = record.get(place).unwrap_or_default();
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            *value = number.ok_or_else(|| format!("{name}: {} is not a finite number", quoted(text.as_bytes())))?;
        }
        let [time_s, scalar_nt, x, y, z] = values;
        if self.time_s.last().is_some_and(|&last| time_s <= last) {
            return Err(format!("time_s: {time_s} is not after the row before"));
        }
        self.time_s.push(time_s);
        self.scalar_nt.push(scalar_nt);
        self.flux_nt.push([x, y, z]);
        Ok(())
    }

    /// The usual step, s: the median.
    pub fn step_s(&self) -> f64 {
        median(self.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect())
    }

    /// Where a time lies among its rows; `None` beyond its ends and in a gap.
    pub(super) fn place(&self, time_s: f64, step_s: f64) -> Option<Place> {
        let last = self.time_s.len() - 1;
        let is_gap = |k: usize| k == last || self.time_s[k + 1] - self.time_s[k] > LONGEST_STEP * step_s;
        let at = self.time_s.partition_point(|&own_s| own_s <= time_s).checked_sub(1)?;
        // On the last row before a gap it is what that row says.
        let is_on_row = time_s - self.time_s[at] < 1e-9;
        let before = if is_gap(at) && is_on_row { at.checked_sub(1)? } else { at };
        if is_gap(before) {
            return None;
        }
        let half = NODES / 2;
        let lowest = (before + 1).saturating_sub(half);
        let highest = (before + half).min(last);
        let first = (lowest..before).rev().find(|&k| is_gap(k)).map_or(lowest, |k| k + 1);
        let end = (before + 1..highest).find(|&k| is_gap(k)).unwrap_or(highest) + 1;
        let nodes = &self.time_s[first..end];
        Some(Place { first, weights: (0..nodes.len()).map(|of| lagrange(nodes, of, time_s)).collect() })
    }
}

/// Where the columns are that a simulation must have.
fn places(headers: &csv::StringRecord) -> Result<[usize; COLUMNS.len()], String> {
    let mut places = [0; COLUMNS.len()];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        let found = headers.iter().position(|header| header.trim_start_matches('\u{feff}') == name);
        *place = found.ok_or_else(|| {
            let there = headers.iter().take(12).collect::<Vec<_>>().join(", ");
            format!("a simulation needs the column {name}; it has {}", shortened(there.as_bytes(), 200))
        })?;
    }
    Ok(places)
}

/// Rows about a time, and how they weigh (Lagrange's polynomials).
pub(super) struct Place {
    first: usize,
    weights: Vec<f64>,
}

impl Place {
    pub(super) fn of(&self, values: &[f64]) -> f64 {
        self.weights.iter().zip(&values[self.first..]).map(|(weight, value)| weight * value).sum()
    }

    pub(super) fn of_vectors(&self, values: &[[f64; 3]]) -> [f64; 3] {
        std::array::from_fn(|i| self.weights.iter().zip(&values[self.first..]).map(|(weight, v)| weight * v[i]).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT";

    fn refused(text: &str) -> String {
        SimulatedTrack::from_reader("sim.csv", text.as_bytes()).expect_err("refused").to_string()
    }

    #[test]
    fn what_is_wrong_is_said_with_file_line_and_column() {
        assert!(
            refused("time_s,scalar_nT\n").contains("sim.csv:1: a simulation needs the column flux_x_nT; it has time_s")
        );
        assert_eq!(
            refused(&format!("{HEADER}\n0,1,2,3,4\n0.1,5o123,2,3,4\n")),
            "sim.csv:3: scalar_nT: \"5o123\" is not a finite number"
        );
        assert!(refused(&format!("{HEADER}\n0,1,2,3,4\n0,1,2,3,4\n")).contains("sim.csv:3: time_s: 0 is not after"));
        assert!(refused(&format!("{HEADER}\n0,1,2,3\n")).contains("sim.csv:2"));
        assert!(refused(&format!("{HEADER}\n0,1,2,3,4\n")).contains("at least 100 rows"));
        assert!(refused("").contains("sim.csv:1"));
    }

    #[test]
    fn between_its_rows_it_is_a_polynomial_and_in_a_gap_it_is_nothing() {
        let rows = (0..120).map(|k| 0.04 * f64::from(k) + if k < 60 { 0.0 } else { 1.0 });
        let value = |t: f64| 5e4 + 3.0 * t - 2.0 * t * t + 0.5 * t.powi(5);
        let text: String = rows.map(|t| format!("{t},{},{t},1,2\n", value(t))).collect();
        let track = SimulatedTrack::from_reader("sim.csv", format!("{HEADER}\n{text}").as_bytes()).expect("whole");
        let step_s = track.step_s();
        assert!((step_s - 0.04).abs() < 1e-9);
        for time_s in [0.0, 0.013, 1.0, 2.36, 3.4, 3.51, 5.76] {
            let place = track.place(time_s, step_s).expect("there");
            assert!((place.of(&track.scalar_nt) - value(time_s)).abs() < 1e-6, "{time_s}");
            assert!((place.of_vectors(&track.flux_nt)[0] - time_s).abs() < 1e-9, "{time_s}");
        }
        assert!([-0.01, 2.4, 3.0, 5.8].iter().all(|time_s| track.place(*time_s, step_s).is_none()));
    }
}
