//! Of the body itself: currents without a rhythm, a loose fin, iron that remembers, a part that is moved.

use rand::RngExt;

use super::super::super::grid::{FINE_HZ, Grid};
use super::super::super::vector::{dot, length, scaled};
use super::super::super::{Change, World};
use super::super::shape::{along, any_moment, with_play};
use crate::random::Random;

/// A current that comes and goes without a rhythm, in a moment fixed in the body.
pub(super) fn telegraph_current(world: &World, draw: &mut Random) -> Change {
    let chance = 1.0 / (10.0 * draw.random_range(2.0..15.0));
    let mut is_on = draw.random_bool(0.5);
    let mut next = || {
        is_on ^= draw.random_bool(chance);
        f64::from(u8::from(is_on))
    };
    let course: Vec<f64> = (0..world.rows()).map(|_| next()).collect();
    Change::of_scalar(along(world, any_moment(draw), &course))
}

/// A steel fin that follows the rate of yaw once that has taken up the play.
pub(super) fn fin_with_backlash(world: &World, draw: &mut Random) -> Change {
    let yaw = Grid::derivative(&world.motion.heading);
    let rms = (yaw.iter().map(|rate| rate * rate).sum::<f64>() / yaw.len() as f64).sqrt();
    let fin = with_play(&yaw, rms * draw.random_range(0.4..1.2));
    // It cannot turn further than its stop.
    let fin: Vec<f64> = fin.into_iter().map(|angle| (angle / rms).clamp(-2.0, 2.0)).collect();
    Change::of_scalar(along(world, any_moment(draw), &world.grid.at_rows(&fin)))
}

/// Iron that follows the field along an axis with friction: a few elements with play, as Prandtl and Ishlinskii have it.
pub(super) fn hysteresis(world: &World, draw: &mut Random) -> Change {
    let axis = any_moment(draw);
    let axis = scaled(axis, 1.0 / length(axis));
    let drive: Vec<f64> = world.direction.iter().map(|&c| dot(c, axis)).collect();
    let mean = drive.iter().sum::<f64>() / drive.len() as f64;
    let rms = (drive.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / drive.len() as f64).sqrt();
    let mut moment = vec![0.0; drive.len()];
    for play in [0.3, 0.8, 1.6] {
        let weight = draw.random_range(0.3..1.0);
        moment.iter_mut().zip(with_play(&drive, play * rms)).for_each(|(sum, x)| *sum += weight * x);
    }
    let course = world.grid.at_rows(&moment);
    Change::of_scalar(along(world, axis, &course))
}

/// A tool or a flap that is moved now and then, within a second or some.
pub(super) fn moving_part(world: &World, draw: &mut Random) -> Change {
    let mut place = Vec::with_capacity(world.grid.len());
    let (mut at, mut goal, mut speed) = (0.0_f64, 0.0, 1.0);
    let chance = 1.0 / (FINE_HZ * draw.random_range(15.0..60.0));
    for _ in 0..world.grid.len() {
        if draw.random_bool(chance) {
            goal = draw.random_range(-1.0..1.0);
            speed = 1.0 / draw.random_range(0.5..4.0);
        }
        at += (goal - at).clamp(-speed / FINE_HZ, speed / FINE_HZ);
        place.push(at);
    }
    // As it turns, its moment turns.
    let (still, turned) = (any_moment(draw), any_moment(draw));
    let place = world.grid.at_rows(&place);
    let first = along(world, still, &place);
    let second = along(world, turned, &place.iter().map(|x| x * x).collect::<Vec<f64>>());
    Change::of_scalar(first.iter().zip(&second).map(|(a, b)| a + b).collect())
}
