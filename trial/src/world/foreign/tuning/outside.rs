//! From outside the body: a tone that wanders, noise that swells.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::super::grid::Grid;
use super::super::super::{Change, World};
use crate::random::Random;

/// A motor whose speed is not governed: 0.3 to 2.5 Hz, wandering by a tenth of it within a minute.
pub(super) fn wandering_tone(world: &World, draw: &mut Random) -> Change {
    let middle_hz: f64 = draw.random_range(0.3..2.5);
    let keep = 1.0 - 1.0 / 600.0;
    let step_hz = 0.1 * middle_hz * (1.0_f64 - keep * keep).sqrt();
    let (mut away_hz, mut cycles) = (0.0, draw.random_range(0.0..1.0));
    let mut next = || {
        let normal: f64 = StandardNormal.sample(draw);
        away_hz = keep * away_hz + step_hz * normal;
        cycles += (middle_hz + away_hz) / 10.0;
        libm::sin(TAU * cycles)
    };
    Change::of_scalar((0..world.rows()).map(|_| next()).collect())
}

/// Noise that comes in bursts: rain on the surface, a winch, a bad contact.
pub(super) fn uneven_noise(world: &World, draw: &mut Random) -> Change {
    let each_s = draw.random_range(10.0..60.0);
    let bursts = ((world.grid.duration_s() / each_s) as usize).max(3);
    let loud: Vec<f64> = (0..=bursts).map(|_| if draw.random_bool(0.35) { 1.0 } else { 0.05 }).collect();
    let mut next = |row: usize| {
        let normal: f64 = StandardNormal.sample(draw);
        loud[((Grid::row_s(row) / each_s) as usize).min(bursts)] * normal
    };
    Change::of_scalar((0..world.rows()).map(&mut next).collect())
}
