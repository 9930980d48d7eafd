//! Moments with a memory: what they are depends on how the body has lain before.

use rand::RngExt;

use super::super::super::grid::{FINE_HZ, Grid};
use super::super::super::vector::{Vector, dot, length, scaled};
use super::super::super::{Change, World};
use super::super::mechanism::{Mechanism, driven};
use super::super::shape::{along_fine, any_axis, cosine, standard};
use crate::random::Random;

pub(super) static ALL: [Mechanism; 5] = [
    driven("two_relaxations", &["attitude_history"], two_relaxations),
    driven("viscous_moment", &["attitude_history"], viscous_moment),
    driven("iron_of_relays", &["attitude_history"], iron_of_relays),
    driven("shaken_remanence", &["attitude_history"], shaken_remanence),
    driven("floating_magnet", &["attitude_history"], floating_magnet),
];

/// Time constants of a viscous moment, one an octave, s.
const OCTAVES_S: [f64; 7] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];

/// Iron that takes up the field along its axis with two time constants: relaxation of two kinds of grains.
fn two_relaxations(world: &World, draw: &mut Random) -> Change {
    let axis = any_axis(draw);
    let drive = cosine(world, axis);
    let (fast_s, slow_s, share) =
        (draw.random_range(0.3..1.0), draw.random_range(3.0..15.0), draw.random_range(0.3..0.7));
    let (fast, slow) = (Grid::low_pass(&drive, fast_s, &[]), Grid::low_pass(&drive, slow_s, &[]));
    let moment: Vec<f64> = fast.iter().zip(&slow).map(|(fast, slow)| share * fast + (1.0 - share) * slow).collect();
    Change::of_scalar(along_fine(world, axis, &moment))
}

/// Iron that creeps after the field for a minute and more, as the logarithm of time: as much in every octave of time constants.
fn viscous_moment(world: &World, draw: &mut Random) -> Change {
    let axis = any_axis(draw);
    let drive = cosine(world, axis);
    let mut moment = vec![0.0; drive.len()];
    for time_s in OCTAVES_S {
        moment.iter_mut().zip(Grid::low_pass(&drive, time_s, &[])).for_each(|(sum, x)| *sum += x);
    }
    // What creeps along one axis acts along another.
    Change::of_scalar(along_fine(world, any_axis(draw), &moment))
}

/// Iron as a crowd of relays that each turn over at two fields of their own (Preisach 1935).
fn iron_of_relays(world: &World, draw: &mut Random) -> Change {
    let axis = any_axis(draw);
    let drive = standard(&cosine(world, axis));
    let mut moment = vec![0.0; drive.len()];
    for _ in 0..24 {
        let (middle, half) = (draw.random_range(-1.5..1.5), draw.random_range(0.2..0.9));
        moment.iter_mut().zip(relay(&drive, [middle - half, middle + half])).for_each(|(sum, x)| *sum += x);
    }
    Change::of_scalar(along_fine(world, axis, &moment))
}

/// Remanence that every shake brings nearer to the field that it is shaken in.
fn shaken_remanence(world: &World, draw: &mut Random) -> Change {
    let rate: Vec<f64> = world.rate.iter().map(|&rate| length(rate)).collect();
    let mean = rate.iter().sum::<f64>() / rate.len() as f64;
    let memory = mean * draw.random_range(4.0..15.0);
    // As it came to lie before: what it was made with is long gone.
    let mut moment = world.direction[0];
    let weights: Vector = std::array::from_fn(|_| draw.random_range(0.2..1.0));
    let mut next = |(&c, rate): (&Vector, &f64)| {
        let by = (rate / (memory * FINE_HZ)).min(1.0);
        moment = std::array::from_fn(|k| moment[k] + by * (c[k] - moment[k]));
        dot(std::array::from_fn(|k| weights[k] * moment[k]), c)
    };
    let fine: Vec<f64> = world.direction.iter().zip(&rate).map(&mut next).collect();
    Change::of_scalar(world.grid.at_rows(&fine))
}

/// A magnet that floats in oil and turns after the field, like a compass, near the sensor.
fn floating_magnet(world: &World, draw: &mut Random) -> Change {
    let (time_s, place) = (draw.random_range(0.5..4.0), any_axis(draw));
    let needle = following(&world.direction, time_s);
    let at = |(&c, &n): (&Vector, &Vector)| 3.0 * dot(n, place) * dot(place, c) - dot(n, c);
    let fine: Vec<f64> = world.direction.iter().zip(&needle).map(at).collect();
    Change::of_scalar(world.grid.at_rows(&fine))
}

/// 1 above the upper threshold, -1 below the lower one, and what it was in between.
fn relay(drive: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    let mut state = -1.0;
    let mut next = |&x: &f64| {
        if x >= high {
            state = 1.0;
        } else if x <= low {
            state = -1.0;
        }
        state
    };
    drive.iter().map(&mut next).collect()
}

/// A unit vector that turns towards each direction with a torque as the sine of the angle, in drag.
fn following(direction: &[Vector], time_s: f64) -> Vec<Vector> {
    let mut needle = direction[0];
    let mut next = |&c: &Vector| {
        let along = dot(needle, c);
        let turned: Vector = std::array::from_fn(|k| needle[k] + (c[k] - along * needle[k]) / (time_s * FINE_HZ));
        needle = scaled(turned, 1.0 / length(turned));
        needle
    };
    direction.iter().map(&mut next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_relay_keeps_its_state_between_its_thresholds() {
        assert_eq!(relay(&[0.0, 0.9, 1.0, 0.0, -0.9, -1.0, 0.0], [-1.0, 1.0]), [-1.0, -1.0, 1.0, 1.0, 1.0, -1.0, -1.0]);
    }

    #[test]
    fn a_needle_closes_the_tangent_of_half_its_angle_exponentially() {
        // d angle / dt = -sin(angle) / tau.
        let mut field = vec![[0.0, 1.0, 0.0]; 301];
        field[0] = [1.0, 0.0, 0.0];
        let needle = following(&field, 1.5);
        let angle = libm::acos(needle[300][1]);
        let exact = 2.0 * libm::atan(libm::exp(-3.0 / 1.5));
        assert!((angle - exact).abs() < 2e-3, "{angle} {exact}");
    }
}
