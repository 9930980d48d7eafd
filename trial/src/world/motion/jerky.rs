//! Towed in short waves on a cable that snatches: attitude sets in within tenths of a second, and goes back.

use rand::RngExt;

use super::super::grid::Grid;
use super::course::Motion;
use super::lake;
use super::script::{degrees, jerk};
use crate::random::Random;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    let mut motion = Motion { name: "jerky", ..lake::draw(grid, draw) };
    let apart_s = draw.random_range(6.0..25.0);
    let mut from_s = draw.random_range(2.0..apart_s);
    while from_s < grid.duration_s() {
        let angle = degrees([2.0, 12.0], draw) * if draw.random_bool(0.5) { 1.0 } else { -1.0 };
        let (sets_in_s, stays_s, back_s) =
            (draw.random_range(0.1..0.3), draw.random_range(0.5..6.0), draw.random_range(0.2..2.0));
        let axis = match draw.random_range(0..3_u8) {
            0 => &mut motion.roll,
            1 => &mut motion.pitch,
            _ => &mut motion.heading,
        };
        jerk(grid, axis, from_s, [sets_in_s, stays_s, back_s], angle);
        from_s += apart_s * draw.random_range(0.3..2.0);
    }
    motion
}
