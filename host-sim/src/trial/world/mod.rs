//! The trial's own world, from the definitions of the effects alone and not from the simulator that the diagnosis fits:
//! what the trial says is then no praise of a program by itself.
//!
//! ```text
//! motion -> direction -> 18 terms + Earth's field = clean scalar, at 100 Hz
//!   + what each hidden effect changes, each on the clean signals    (effects, foreign)
//!   + noise -> repeats, rounding -> holes -> CSV
//! ```

mod body;
mod columns;
mod earth;
pub(super) mod effects;
pub(super) mod foreign;
mod grid;
mod motion;
mod noise;
pub(super) mod recorded;
mod table;
mod tones;
mod vector;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use body::Body;
use columns::Columns;
use grid::Grid;
use motion::Motion;
use vector::{Vector, dot, length, scaled, to_body};

pub(super) use body::columns as terms;
pub(super) use noise::{BAND_HZ, Noise};

/// Where all chance comes from.
pub(super) type Draw = ChaCha8Rng;

/// A place, a body, a motion and two noisy sensors, without any effect.
pub(super) struct World {
    grid: Grid,
    motion: Motion,
    body: Body,
    columns: Columns,
    /// Of the Earth's field in body axes, at 100 Hz.
    direction: Vec<Vector>,
    /// Its rate, 1/s.
    rate: Vec<Vector>,
    /// Strength of the field, nT.
    field_nt: Vec<f64>,
    /// What the scalar would read without noise, nT.
    scalar_nt: Vec<f64>,
    /// The eddy part of it, nT.
    eddy_nt: Vec<f64>,
    /// Of the scalar.
    pub(super) noise: Noise,
    /// Of each fluxgate component, white, nT.
    pub(super) flux_noise_nt: f64,
    /// Whether the noise is in the signals already: they were recorded.
    is_noisy: bool,
}

/// What the two sensors say at each row.
#[derive(Clone, Debug)]
pub(super) struct Readings {
    pub(super) scalar_nt: Vec<f64>,
    pub(super) flux_nt: Vec<Vector>,
}

/// Values that are added to the clean readings; empty where a sensor is not touched.
#[derive(Clone, Debug, Default)]
pub(super) struct Change {
    pub(super) scalar_nt: Vec<f64>,
    pub(super) flux_nt: Vec<Vector>,
}

/// What happens to the readings when all else is done, noise included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Last {
    /// The scalar's reading is repeated with this probability.
    Repeat(f64),
    /// The fluxgate's components are rounded to this, nT.
    Round(f64),
}

impl Readings {
    /// What an effect changes.
    pub(super) fn add(&mut self, change: &Change) {
        self.scalar_nt.iter_mut().zip(&change.scalar_nt).for_each(|(nt, off)| *nt += off);
        self.flux_nt.iter_mut().zip(&change.flux_nt).for_each(|(nt, off)| (0..3).for_each(|k| nt[k] += off[k]));
    }
}

impl Change {
    /// As many times as large.
    pub(super) fn times(mut self, by: f64) -> Self {
        self.scalar_nt.iter_mut().chain(self.flux_nt.iter_mut().flatten()).for_each(|nt| *nt *= by);
        self
    }
}

impl World {
    /// Any world with so many rows. The body, the place and what is recorded come from `draw`, how the body moves from
    /// `motion_draw`.
    pub(super) fn draw(rows: usize, draw: &mut Draw, motion_draw: &mut Draw) -> Self {
        let grid = Grid::new(rows);
        let motion = motion::of(&grid, draw.random_range(0..3_u8), motion_draw);
        let earth = earth::draw(&grid, motion.depth.is_none(), draw);
        let body = Body::draw(draw);
        let columns = Columns::draw(rows, draw);
        let noise_rms_nt = 0.02 * libm::pow(5.0, draw.random::<f64>());
        let noise = Noise::draw(noise_rms_nt, draw);
        let flux_noise_nt = 0.2 * libm::pow(5.0, draw.random::<f64>());
        let direction: Vec<Vector> = (0..grid.len())
            .map(|at| to_body(earth.direction, motion.roll[at], motion.pitch[at], motion.heading[at]))
            .collect();
        let rate = rate(&direction);
        let field_nt = earth.field_nt;
        let eddy_nt: Vec<f64> =
            (0..grid.len()).map(|at| dot(direction[at], body.eddy_nt(field_nt[at], rate[at]))).collect();
        let scalar_nt = (0..grid.len())
            .map(|at| field_nt[at] + dot(direction[at], body.still_nt(field_nt[at], direction[at])) + eddy_nt[at])
            .collect();
        let is_noisy = false;
        Self {
            grid,
            motion,
            body,
            columns,
            direction,
            rate,
            field_nt,
            scalar_nt,
            eddy_nt,
            noise,
            flux_noise_nt,
            is_noisy,
        }
    }

    /// `land`, `lake` or `sea`.
    pub(super) fn motion(&self) -> &'static str {
        self.motion.name
    }

    /// Rows before any is lost.
    pub(super) fn rows(&self) -> usize {
        self.grid.rows()
    }

    /// True direction at the rows.
    pub(super) fn directions(&self) -> Vec<Vector> {
        self.grid.at_rows(&self.direction)
    }

    /// True rate of the direction at the rows, 1/s.
    pub(super) fn rates(&self) -> Vec<Vector> {
        self.grid.at_rows(&self.rate)
    }

    /// Without effect and noise.
    pub(super) fn clean(&self) -> Readings {
        let vector = |row: usize| scaled(self.direction[Grid::of_row(row)], self.field_nt[Grid::of_row(row)]);
        Readings { scalar_nt: self.grid.at_rows(&self.scalar_nt), flux_nt: (0..self.rows()).map(vector).collect() }
    }

    /// With effects and with noise.
    pub(super) fn record(&self, changes: &[Change], last: Vec<(Last, Draw)>, draw: &mut Draw) -> Readings {
        let mut readings = self.clean();
        changes.iter().for_each(|change| readings.add(change));
        if !self.is_noisy {
            self.add_noise(&mut readings, draw);
        }
        for (last, mut draw) in last {
            self.finish(&mut readings, last, &mut draw);
        }
        readings
    }

    fn add_noise(&self, readings: &mut Readings, draw: &mut Draw) {
        readings.scalar_nt.iter_mut().zip(self.noise.sample(self.rows(), draw)).for_each(|(nt, off)| *nt += off);
        for component in readings.flux_nt.iter_mut().flatten() {
            let unit: f64 = StandardNormal.sample(draw);
            *component += self.flux_noise_nt * unit;
        }
    }

    /// As a file.
    pub(super) fn csv(&self, readings: &Readings, draw: &mut Draw) -> String {
        table::csv(self, readings, draw)
    }

    fn finish(&self, readings: &mut Readings, last: Last, draw: &mut Draw) {
        match last {
            Last::Repeat(probability) => {
                let starts: Vec<usize> = self.columns.segments(self.rows()).iter().map(|rows| rows.start).collect();
                for row in 1..self.rows() {
                    // Not across a gap.
                    if draw.random_bool(probability) && !starts.contains(&row) {
                        readings.scalar_nt[row] = readings.scalar_nt[row - 1];
                    }
                }
            }
            Last::Round(step_nt) => {
                readings.flux_nt.iter_mut().flatten().for_each(|nt| *nt = step_nt * (*nt / step_nt).round());
            }
        }
    }

    fn depth_m(&self) -> Option<Vec<f64>> {
        self.motion.depth.as_ref().map(|depth| self.grid.at_rows(&depth.depth_m))
    }

    fn heading_deg(&self, row: usize) -> f64 {
        self.motion.heading[Grid::of_row(row)].to_degrees()
    }
}

/// Magnitudes of the fluxgate's readings, nT.
pub(super) fn magnitudes(flux_nt: &[Vector]) -> Vec<f64> {
    flux_nt.iter().map(|&reading| length(reading)).collect()
}

fn rate(direction: &[Vector]) -> Vec<Vector> {
    let of = |k: usize| Grid::derivative(&direction.iter().map(|c| c[k]).collect::<Vec<f64>>());
    let [x, y, z] = [of(0), of(1), of(2)];
    (0..direction.len()).map(|at| [x[at], y[at], z[at]]).collect()
}

#[cfg(test)]
mod tests;
