//! Turns and manoeuvres, without a kink.

use std::f64::consts::TAU;

use rand::RngExt;

use super::super::grid::{FINE_HZ, Grid};
use crate::random::Random;

/// Seconds in which a manoeuvre swells and dies away.
const RAMP_S: f64 = 2.0;
/// Standard deviations between a tenth and nine tenths of a normal distribution.
const TENTH_TO_NINE_TENTHS: f64 = 2.563_103_131_089_201;

/// From 0 to 1 between 0 and 1; the rate and its rate are zero at both ends: no torque sets in at once.
fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
}

/// Any angle between two that are given in degrees, rad.
pub(super) fn degrees(range: [f64; 2], draw: &mut Random) -> f64 {
    draw.random_range(range[0]..range[1]).to_radians()
}

/// Add a turn by `angle` to a heading.
pub(super) fn turn(grid: &Grid, heading: &mut [f64], from_s: f64, lasts_s: f64, angle: f64) {
    for (value, t) in heading.iter_mut().zip(grid.times_s()) {
        *value += angle * smooth_step((t - from_s) / lasts_s);
    }
}

/// From 0 to 1 about 0, from a tenth to nine tenths in the time `rise`: its rate is a normal curve, of all that are as quick
/// the one with the least above a frequency.
fn normal_step(x: f64, rise: f64) -> f64 {
    let sigma = rise / TENTH_TO_NINE_TENTHS;
    0.5 * (1.0 + libm::erf(x / (sigma * std::f64::consts::SQRT_2)))
}

/// Add an angle that sets in about `at_s`, stays and goes back; `rises_s` is how long setting in and going back take.
pub(super) fn jerk(grid: &Grid, angle: &mut [f64], at_s: f64, stays_s: f64, rises_s: [f64; 2], size: f64) {
    let [sets_in_s, back_s] = rises_s;
    let first = ((at_s - 3.0 * sets_in_s - grid.start_s()) * FINE_HZ) as usize;
    let count = ((stays_s + 3.0 * (sets_in_s + back_s)) * FINE_HZ) as usize;
    for (value, t) in angle.iter_mut().zip(grid.times_s()).skip(first).take(count) {
        *value += size * (normal_step(t - at_s, sets_in_s) - normal_step(t - at_s - stays_s, back_s));
    }
}

/// Add an oscillation that swells, goes on, and dies away.
pub(super) fn oscillate(grid: &Grid, angle: &mut [f64], from_s: f64, to_s: f64, hz: f64, amplitude: f64) {
    for (value, t) in angle.iter_mut().zip(grid.times_s()) {
        let inside = smooth_step((t - from_s).min(to_s - t) / RAMP_S);
        if inside > 0.0 {
            *value += amplitude * inside * libm::sin(TAU * hz * (t - from_s));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jerk_sets_in_stays_and_goes_back() {
        let grid = Grid::new(200);
        let mut angle = vec![0.0; grid.len()];
        jerk(&grid, &mut angle, 5.0, 4.0, [0.2, 1.0], 0.1);
        let at = |t: f64| grid.at(&angle, t);
        for (t, of) in [
            (4.5, 0.0),
            (4.9, 0.1),
            (5.0, 0.5),
            (5.1, 0.9),
            (7.0, 1.0),
            (8.5, 0.9),
            (9.0, 0.5),
            (9.5, 0.1),
            (15.0, 0.0),
        ] {
            assert!((at(t) - 0.1 * of).abs() < 1e-6, "{t} {}", at(t));
        }
    }
}
