//! From outside the body: a tone that wanders, iron on the ground, noise that swells.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::grid::Grid;
use super::super::vector::{Vector, dot, length, scaled};
use super::super::{Change, World};
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

/// Pieces of iron that the body passes: dipoles, in the field of both sensors.
pub(super) fn passing_iron(world: &World, draw: &mut Random) -> Change {
    let mut scalar_nt = vec![0.0; world.rows()];
    for _ in 0..draw.random_range(2..=5_u8) {
        let at_s = world.grid.duration_s() * draw.random_range(0.05..0.95);
        // Time to pass the distance to it.
        let width_s = draw.random_range(1.5..5.0);
        let moment: Vector = std::array::from_fn(|_| draw.random_range(-1.0..1.0));
        let moment = scaled(moment, draw.random_range(0.4..1.0) / length(moment).max(0.1));
        let along: Vector = std::array::from_fn(|_| draw.random_range(-1.0..1.0));
        let along = scaled(along, 1.0 / length(along).max(0.1));
        for (row, value) in scalar_nt.iter_mut().enumerate() {
            let place = [(Grid::row_s(row) - at_s) / width_s, 0.3, 1.0];
            let distance = length(place);
            let unit = scaled(place, 1.0 / distance);
            *value += (3.0 * dot(moment, unit) * dot(unit, along) - dot(moment, along)) / distance.powi(3);
        }
    }
    let flux_nt = world.directions().iter().zip(&scalar_nt).map(|(c, nt)| scaled(*c, *nt)).collect();
    Change { scalar_nt, flux_nt }
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
