//! Of the sensor and its clock: a reading that hops, noise that the angle makes, rows that are late in turn or in turns.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::super::grid::Grid;
use super::super::super::vector::dot;
use super::super::super::{Change, World};
use super::super::shape::{any_axis, standard};
use crate::random::Random;

/// Popcorn noise: the reading hops between two levels, several times a minute to several times a second.
pub(super) fn popcorn_noise(world: &World, draw: &mut Random) -> Change {
    let chance = 0.02 * libm::pow(20.0, draw.random::<f64>());
    let mut is_high = false;
    let mut next = || {
        is_high ^= draw.random_bool(chance);
        f64::from(u8::from(is_high))
    };
    Change::of_scalar((0..world.rows()).map(|_| next()).collect())
}

/// The signal of an optical sensor fades near its axis and across it, and its noise grows, without an edge.
pub(super) fn noise_by_angle(world: &World, draw: &mut Random) -> Change {
    let axis = any_axis(draw);
    let mut next = |&c: &[f64; 3]| {
        let cosine = dot(c, axis);
        let signal = 2.0 * cosine.abs() * (1.0 - cosine * cosine).max(0.0).sqrt();
        let normal: f64 = StandardNormal.sample(draw);
        normal / signal.max(0.05)
    };
    Change::of_scalar(world.directions().iter().map(&mut next).collect())
}

/// A multiplexer: one row of three to seven is read late.
pub(super) fn late_row_of_several(world: &World, draw: &mut Random) -> Change {
    let every = draw.random_range(3..8);
    let late_s = draw.random_range(0.01..0.05);
    read_late(world, |row, _| if row % every == 0 { late_s } else { 0.0 })
}

/// A cable that turns on a drum of slip rings: the reading comes the later the faster the body yaws.
pub(super) fn late_in_turns(world: &World, _: &mut Random) -> Change {
    let yaw = standard(&world.grid.at_rows(&Grid::derivative(&world.motion.heading)));
    read_late(world, |row, _| 0.005 * yaw[row].clamp(-4.0, 4.0))
}

/// The scalar as it was a while before, by row and time since the first one.
fn read_late(world: &World, late_s: impl Fn(usize, f64) -> f64) -> Change {
    let now = world.grid.at_rows(&world.scalar_nt);
    let change = |row: usize| {
        let time_s = Grid::row_s(row);
        world.grid.at(&world.scalar_nt, time_s - late_s(row, time_s)) - now[row]
    };
    Change::of_scalar((0..world.rows()).map(change).collect())
}
