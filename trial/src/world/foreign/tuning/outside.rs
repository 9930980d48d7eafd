//! From outside the body: a tone that wanders, noise that swells, a cable that strums.

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

/// A cable that strums in the wake it makes: noise about 0.3 to 1.5 Hz, a third to two thirds of that wide.
pub(super) fn strumming_cable(world: &World, draw: &mut Random) -> Change {
    let middle_hz = 0.3 * libm::pow(5.0, draw.random::<f64>());
    let damping = draw.random_range(0.15..0.3);
    let angle = TAU * middle_hz / 10.0;
    let keep = libm::exp(-damping * angle);
    let (mut last, mut before) = (0.0, 0.0);
    let mut next = || {
        let driven: f64 = StandardNormal.sample(draw);
        (last, before) = (2.0 * keep * libm::cos(angle) * last - keep * keep * before + driven, last);
        last
    };
    Change::of_scalar((0..world.rows()).map(|_| next()).collect())
}
