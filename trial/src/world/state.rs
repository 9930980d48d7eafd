//! What is true at every instant of a recording: a place, a body, its motion, and two noisy sensors.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::body::Body;
use super::columns::Columns;
use super::earth;
use super::grid::Grid;
use super::motion::{self, Motion};
use super::noise::Noise;
use super::readings::{Change, Last, Readings};
use super::vector::{Vector, dot, scaled, to_body};
use crate::random::Random;
use crate::setting::Setting;

/// A place, a body, a motion and two noisy sensors, without any effect.
#[derive(Clone)]
pub(crate) struct World {
    pub(super) grid: Grid,
    pub(super) motion: Motion,
    pub(super) body: Body,
    pub(super) columns: Columns,
    /// Of the Earth's field: north, east, down.
    pub(super) earth: Vector,
    /// Of the Earth's field in body axes, at 100 Hz.
    pub(super) direction: Vec<Vector>,
    /// Its rate, 1/s.
    pub(super) rate: Vec<Vector>,
    /// Strength of the field, nT.
    pub(super) field_nt: Vec<f64>,
    /// What the scalar would read without noise, nT.
    pub(super) scalar_nt: Vec<f64>,
    /// The eddy part of it, nT.
    pub(super) eddy_nt: Vec<f64>,
    /// Of the scalar.
    pub(crate) noise: Noise,
    /// Of each fluxgate component, white, nT.
    pub(crate) flux_noise_nt: f64,
    /// Whether the noise is in the signals already: they were recorded.
    pub(super) is_noisy: bool,
}

impl World {
    /// Any world with so many rows. The body, the place and what is recorded come from `draw`, how the body moves from
    /// `motion_draw`.
    pub(crate) fn draw(rows: usize, setting: Setting, draw: &mut Random, motion_draw: &mut Random) -> Self {
        let grid = Grid::new(rows);
        let motion = motion::of(&grid, draw.random_range(0..motion::COUNT), setting, motion_draw);
        let earth = earth::draw(&grid, motion.name == "land", draw);
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
            earth: earth.direction,
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

    /// `land`, `lake`, `sea`, `jerky` or `flight`.
    pub(crate) fn motion(&self) -> &'static str {
        self.motion.name
    }

    /// The load whose current is recorded.
    pub(crate) fn load(&self) -> Option<&'static str> {
        self.columns.load.as_ref().map(|(name, _)| *name)
    }

    /// Rows before any is lost.
    pub(crate) fn rows(&self) -> usize {
        self.grid.rows()
    }

    /// True direction at the rows.
    pub(crate) fn directions(&self) -> Vec<Vector> {
        self.grid.at_rows(&self.direction)
    }

    /// True rate of the direction at the rows, 1/s.
    pub(crate) fn rates(&self) -> Vec<Vector> {
        self.grid.at_rows(&self.rate)
    }

    /// Without effect and noise.
    pub(crate) fn clean(&self) -> Readings {
        let vector = |row: usize| scaled(self.direction[Grid::of_row(row)], self.field_nt[Grid::of_row(row)]);
        Readings { scalar_nt: self.grid.at_rows(&self.scalar_nt), flux_nt: (0..self.rows()).map(vector).collect() }
    }

    /// With effects and with noise.
    pub(crate) fn record(&self, changes: &[Change], last: Vec<(Last, Random)>, draw: &mut Random) -> Readings {
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

    fn add_noise(&self, readings: &mut Readings, draw: &mut Random) {
        readings.scalar_nt.iter_mut().zip(self.noise.sample(self.rows(), draw)).for_each(|(nt, off)| *nt += off);
        for component in readings.flux_nt.iter_mut().flatten() {
            let unit: f64 = StandardNormal.sample(draw);
            *component += self.flux_noise_nt * unit;
        }
    }

    fn finish(&self, readings: &mut Readings, last: Last, draw: &mut Random) {
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

    /// Depth at the rows, of a body that is towed, m.
    pub(super) fn depth_m(&self) -> Option<Vec<f64>> {
        self.motion.depth.as_ref().map(|depth| self.grid.at_rows(&depth.depth_m))
    }

    /// Heading at a row, degrees from north by east.
    pub(super) fn heading_deg(&self, row: usize) -> f64 {
        self.motion.heading[Grid::of_row(row)].to_degrees()
    }

    /// Roll and pitch at a row, degrees: starboard down, nose up.
    pub(super) fn tilt_deg(&self, row: usize) -> [f64; 2] {
        [&self.motion.roll, &self.motion.pitch].map(|angle| angle[Grid::of_row(row)].to_degrees())
    }
}

/// Of a direction, 1/s.
pub(super) fn rate(direction: &[Vector]) -> Vec<Vector> {
    let of = |k: usize| Grid::derivative(&direction.iter().map(|c| c[k]).collect::<Vec<f64>>());
    let [x, y, z] = [of(0), of(1), of(2)];
    (0..direction.len()).map(|at| [x[at], y[at], z[at]]).collect()
}
