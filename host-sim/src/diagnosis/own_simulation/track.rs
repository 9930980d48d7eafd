//! A simulation of a user's own: its columns at any rate, and their values between its rows.

use std::path::Path;

use crate::error::HostError;

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
        let file = path.display().to_string();
        let wrong = |line: u64, what: String| HostError::Usage(format!("{file}:{line}: {what}"));
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_path(path)
            .map_err(|error| HostError::Usage(format!("{file}: {error}")))?;
        let headers = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
        let index = |name: &str| {
            let at = headers.iter().position(|header| header.trim_start_matches('\u{feff}') == name);
            at.ok_or_else(|| wrong(1, format!("a simulation needs the column {name}; it has {}", list(&headers))))
        };
        let mut columns = [0; COLUMNS.len()];
        for (column, name) in columns.iter_mut().zip(COLUMNS) {
            *column = index(name)?;
        }
        let mut track = Self { file: file.clone(), ..Self::default() };
        for (row, record) in reader.records().enumerate() {
            let line = row as u64 + 2;
            let record = record.map_err(|error| wrong(line, error.to_string()))?;
            let mut values = [0.0; COLUMNS.len()];
            for ((value, column), name) in values.iter_mut().zip(columns).zip(COLUMNS) {
                let text = record.get(column).unwrap_or_default();
                let number = text.parse().ok().filter(|number: &f64| number.is_finite());
                *value = number.ok_or_else(|| wrong(line, format!("{name}: {text:?} is not a finite number")))?;
            }
            let [time_s, scalar_nt, x, y, z] = values;
            if track.time_s.last().is_some_and(|&last| time_s <= last) {
                return Err(wrong(line, format!("time_s: {time_s} is not after the row before")));
            }
            track.time_s.push(time_s);
            track.scalar_nt.push(scalar_nt);
            track.flux_nt.push([x, y, z]);
        }
        match track.time_s.len() < LEAST_ROWS {
            true => Err(HostError::NotEnough(format!("{file}: a simulation needs at least {LEAST_ROWS} rows"))),
            false => Ok(track),
        }
    }

    /// The usual step, s: the median.
    pub fn step_s(&self) -> f64 {
        let mut steps: Vec<f64> = self.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Where a time lies among its rows; `None` beyond its ends and in a gap.
    pub(super) fn place(&self, time_s: f64, step_s: f64) -> Option<Place> {
        let after = self.time_s.partition_point(|&own_s| own_s <= time_s);
        let last = self.time_s.len() - 1;
        let at_end = after > last && self.time_s[last] >= time_s - 1e-9;
        let before = if at_end { last - 1 } else { after.checked_sub(1).filter(|_| after <= last)? };
        let is_gap = |k: usize| self.time_s[k + 1] - self.time_s[k] > LONGEST_STEP * step_s;
        if is_gap(before) {
            return None;
        }
        let half = NODES / 2;
        let lowest = (before + 1).saturating_sub(half);
        let highest = (before + half).min(last);
        let first = (lowest..before).rev().find(|&k| is_gap(k)).map_or(lowest, |k| k + 1);
        let end = (before + 1..highest).find(|&k| is_gap(k)).unwrap_or(highest) + 1;
        let nodes = &self.time_s[first..end];
        let weight = |of: usize| {
            let others = (0..nodes.len()).filter(|&k| k != of);
            others.map(|k| (time_s - nodes[k]) / (nodes[of] - nodes[k])).product()
        };
        Some(Place { first, weights: (0..nodes.len()).map(weight).collect() })
    }
}

fn list(headers: &csv::StringRecord) -> String {
    headers.iter().take(12).collect::<Vec<_>>().join(", ")
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
