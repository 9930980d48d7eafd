//! Turns and manoeuvres, without a kink.

use std::f64::consts::TAU;

use rand::RngExt;

use super::super::grid::Grid;
use crate::random::Random;

/// Seconds in which a manoeuvre swells and dies away.
const RAMP_S: f64 = 2.0;

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

/// Add an oscillation that swells, goes on, and dies away.
pub(super) fn oscillate(grid: &Grid, angle: &mut [f64], from_s: f64, to_s: f64, hz: f64, amplitude: f64) {
    for (value, t) in angle.iter_mut().zip(grid.times_s()) {
        let inside = smooth_step((t - from_s).min(to_s - t) / RAMP_S);
        if inside > 0.0 {
            *value += amplitude * inside * libm::sin(TAU * hz * (t - from_s));
        }
    }
}
