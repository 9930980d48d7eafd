//! The clean trajectory that effects act on: noise-free signals as functions of continuous time.
//!
//! The simulator makes it from physics, the diagnosis from a recording (direction from the fluxgate, field from the
//! slow background, coefficients from a refit): nothing here knows which.

mod grid;
pub(crate) mod tolles_lawson;

pub(crate) use grid::GAUSS_LEGENDRE;
pub use grid::Grid;
pub use tolles_lawson::{Interference, interference, vector_nt};

use std::ops::Range;
use std::sync::Arc;

use towmag::model::TERMS;

pub use crate::recording::LONGEST_STEP_S;
use crate::recording::{Column, load_of};

/// What [`Signals`] are made of, but for the body: how it moves, through which field, and what is recorded beside.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Points per second of the dense grid: 50 to 100. At least 4 points.
    pub rate_hz: f64,
    /// Time of the first point of the grid, s since the first row; some seconds before it.
    pub start_s: f64,
    /// Magnitude of the Earth's field with geology and diurnal change, nT, on the grid.
    pub field_nt: Vec<f64>,
    /// Its direction in body axes, unit vectors, on the grid.
    pub direction: Vec<[f64; 3]>,
    /// When the rows were taken, s since the first row, ascending.
    pub epochs_s: Vec<f64>,
    /// Time of the first row on the recording's own axis, s.
    pub first_row_time_s: f64,
    /// Depth of the body, m, one value a row.
    pub depth_m: Option<Vec<f64>>,
    /// Temperature at the fluxgate, degC, one value a row.
    pub temperature_deg_c: Option<Vec<f64>>,
    /// Current of each named load, A, one value a row.
    pub currents_a: Vec<(String, Vec<f64>)>,
    /// Other columns by their names, one value a row, for the effects that users write.
    pub columns: Vec<(String, Vec<f64>)>,
}

/// Rows without a gap between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Which rows.
    pub epochs: Range<usize>,
    /// From when to when signals may be taken for these rows, s: to the ends of the grid, but not across a gap.
    pub span_s: [f64; 2],
}

/// Noise-free signals on a dense grid, and at the rows.
#[derive(Clone, Debug)]
pub struct Signals {
    motion: Arc<Motion>,
    /// The 18 coefficients in the units of eq. (4).
    coefficients: [f64; TERMS],
    /// `s`, nT, on the grid.
    scalar_nt: Vec<f64>,
    /// Eddy part of `A beta`, nT, on the grid.
    eddy_nt: Vec<f64>,
    /// `s`, nT, at the rows.
    scalar_at_rows_nt: Vec<f64>,
}

/// What is the same whatever the coefficients: an hour of it takes tens of megabytes, and a diagnosis has dozens of bodies on one motion.
#[derive(Debug)]
struct Motion {
    trajectory: Trajectory,
    grid: Grid,
    segments: Vec<Segment>,
    /// Time derivative of the direction, 1/s, on the grid.
    direction_rate: Vec<[f64; 3]>,
    rows: Rows,
}

/// Field and direction at the rows.
#[derive(Debug, Default)]
pub struct Rows {
    /// `F`, nT.
    pub field_nt: Vec<f64>,
    /// `c`, unit vectors.
    pub direction: Vec<[f64; 3]>,
    /// Time derivative of `c`, 1/s.
    pub direction_rate: Vec<[f64; 3]>,
    /// `f = F c`, nT.
    pub flux_nt: Vec<[f64; 3]>,
}

impl Signals {
    /// Everything that follows from a trajectory and the 18 coefficients of a body, in the units of eq. (4).
    pub fn new(trajectory: Trajectory, coefficients: [f64; TERMS]) -> Self {
        Self::of(Arc::new(Motion::new(trajectory)), coefficients)
    }

    /// The same motion with other coefficients: less work than anew, and less memory.
    pub fn with_coefficients(&self, coefficients: [f64; TERMS]) -> Self {
        Self::of(Arc::clone(&self.motion), coefficients)
    }

    fn of(motion: Arc<Motion>, coefficients: [f64; TERMS]) -> Self {
        let Motion { trajectory, direction_rate, rows, .. } = &*motion;
        let on_grid = || {
            let points = trajectory.field_nt.iter().zip(&trajectory.direction).zip(direction_rate);
            let read = points.map(|((&field_nt, &c), &c_rate)| {
                let parts = interference(&coefficients, field_nt, c, c_rate);
                (field_nt + parts.total_nt(), parts.eddy_nt)
            });
            read.unzip()
        };
        let at_row = |row| rows.field_nt[row] + rows.interference(row, &coefficients).total_nt();
        let at_rows = || (0..rows.field_nt.len()).map(at_row).collect();
        let ((scalar_nt, eddy_nt), scalar_at_rows_nt) = rayon::join(on_grid, at_rows);
        Self { motion, coefficients, scalar_nt, eddy_nt, scalar_at_rows_nt }
    }

    /// The dense grid.
    pub fn grid(&self) -> &Grid {
        &self.motion.grid
    }

    /// What they are made of.
    pub fn trajectory(&self) -> &Trajectory {
        &self.motion.trajectory
    }

    /// The 18 coefficients in the units of eq. (4).
    pub fn coefficients(&self) -> &[f64; TERMS] {
        &self.coefficients
    }

    /// Rows without gaps between them, in order.
    pub fn segments(&self) -> &[Segment] {
        &self.motion.segments
    }

    /// Field and direction at the rows.
    pub fn rows(&self) -> &Rows {
        &self.motion.rows
    }

    /// `s = F + A beta` at the rows, nT.
    pub fn scalar_at_rows_nt(&self) -> &[f64] {
        &self.scalar_at_rows_nt
    }

    /// `A beta` of a row in its parts.
    pub(crate) fn interference(&self, row: usize) -> Interference {
        self.rows().interference(row, &self.coefficients)
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.trajectory().epochs_s.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.trajectory().epochs_s.is_empty()
    }

    /// When the rows were taken, s since the first.
    pub fn epochs_s(&self) -> &[f64] {
        &self.trajectory().epochs_s
    }

    /// When a row was taken on the recording's own axis, s.
    pub fn recording_time_s(&self, row: usize) -> f64 {
        self.trajectory().first_row_time_s + self.trajectory().epochs_s[row]
    }

    /// `s` on the grid, nT.
    pub fn scalar_nt(&self) -> &[f64] {
        &self.scalar_nt
    }

    /// The eddy part of `A beta` on the grid, nT.
    pub fn eddy_nt(&self) -> &[f64] {
        &self.eddy_nt
    }

    /// `s` at any time, nT, for rows of a segment: before its begin and after its end, what it was there.
    pub fn scalar_at(&self, segment: &Segment, time_s: f64) -> f64 {
        self.grid().at(&self.scalar_nt, time_s.clamp(segment.span_s[0], segment.span_s[1]))
    }

    /// The current of a load, A, one value a row.
    pub fn current_a(&self, load: &str) -> Option<&[f64]> {
        self.trajectory().currents_a.iter().find(|(name, _)| name == load).map(|(_, current_a)| &current_a[..])
    }

    /// A column of the recording by its name, one value a row.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let other = || self.trajectory().columns.iter().find(|(known, _)| known == name).map(|(_, values)| &values[..]);
        match Column::named(name) {
            Some(Column::Depth) => self.trajectory().depth_m.as_deref(),
            Some(Column::Temperature) => self.trajectory().temperature_deg_c.as_deref(),
            _ => load_of(name).and_then(|load| self.current_a(load)).or_else(other),
        }
    }

    /// Which points of the grid belong to a segment.
    pub fn points(&self, segment: &Segment) -> Range<usize> {
        let point = |time_s: f64| (time_s - self.grid().start_s) * self.grid().rate_hz;
        let first = (point(segment.span_s[0]) + 1e-6).floor().max(0.0) as usize;
        let last = (point(segment.span_s[1]) - 1e-6).ceil().max(0.0) as usize;
        first.min(self.grid().len - 1)..last.min(self.grid().len - 1) + 1
    }
}

impl Motion {
    fn new(trajectory: Trajectory) -> Self {
        let grid = Grid { rate_hz: trajectory.rate_hz, start_s: trajectory.start_s, len: trajectory.field_nt.len() };
        assert!(grid.len >= 5 && trajectory.direction.len() == grid.len, "a grid of at least five points");
        let direction_rate = grid.derivative(&trajectory.direction);
        let rows = Rows::at(&trajectory, &grid, &direction_rate);
        let segments = segments(&trajectory.epochs_s, &grid);
        Self { trajectory, grid, segments, direction_rate, rows }
    }
}

impl Rows {
    fn at(trajectory: &Trajectory, grid: &Grid, direction_rate: &[[f64; 3]]) -> Self {
        let mut rows = Self::default();
        for &time_s in &trajectory.epochs_s {
            let field_nt = grid.at(&trajectory.field_nt, time_s);
            let c = unit(grid.vector_at(&trajectory.direction, time_s));
            rows.field_nt.push(field_nt);
            rows.direction.push(c);
            rows.direction_rate.push(grid.vector_at(direction_rate, time_s));
            rows.flux_nt.push(c.map(|cosine| field_nt * cosine));
        }
        rows
    }

    /// `A beta` of a row in its parts, for coefficients in the units of eq. (4).
    fn interference(&self, row: usize, coefficients: &[f64; TERMS]) -> Interference {
        interference(coefficients, self.field_nt[row], self.direction[row], self.direction_rate[row])
    }
}

/// Interpolation cuts the corners of the sphere.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|component| component / length)
}

fn segments(epochs_s: &[f64], grid: &Grid) -> Vec<Segment> {
    let mut segments: Vec<Segment> = Vec::new();
    for (row, &time_s) in epochs_s.iter().enumerate() {
        match segments.last_mut() {
            Some(last) if time_s - epochs_s[row - 1] <= LONGEST_STEP_S => last.epochs.end = row + 1,
            before => {
                if let Some(last) = before {
                    last.span_s[1] = epochs_s[row - 1];
                }
                let begin_s = if row == 0 { grid.start_s } else { time_s };
                segments.push(Segment { epochs: row..row + 1, span_s: [begin_s, grid.end_s()] });
            }
        }
    }
    segments
}

#[cfg(test)]
pub(crate) mod tests;
