//! Towed in short waves on a cable that snatches: attitude sets in within tenths of a second, and goes back.

use rand::RngExt;

use super::super::grid::Grid;
use super::course::Motion;
use super::script::{degrees, jerk};
use super::{lake, land};
use crate::random::Random;

/// From a tenth to nine tenths of an angle, s.
const LONGEST_RISE_S: f64 = 0.3;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    jerked(Motion { name: "jerky", ..lake::draw(grid, draw) }, [3.0, 12.0], grid, draw)
}

/// Rocked on land by a hand that knocks: what a diagnosis is tuned with in the place of a cable that snatches.
pub(super) fn knocked(grid: &Grid, draw: &mut Random) -> Motion {
    jerked(Motion { name: "knocked", ..land::draw(grid, draw) }, [2.0, 8.0], grid, draw)
}

/// With jerks of so many degrees.
fn jerked(mut motion: Motion, size_deg: [f64; 2], grid: &Grid, draw: &mut Random) -> Motion {
    let apart_s = draw.random_range(6.0..25.0);
    let mut at_s = draw.random_range(2.0..apart_s);
    while at_s < grid.duration_s() {
        let rises_s = [draw.random_range(0.15..LONGEST_RISE_S), draw.random_range(0.3..2.0)];
        // The same torque turns it by as much as the square of the time.
        let share = (rises_s[0] / LONGEST_RISE_S).powi(2);
        let angle = share * degrees(size_deg, draw) * if draw.random_bool(0.5) { 1.0 } else { -1.0 };
        let stays_s = draw.random_range(3.0..8.0);
        let axis = match draw.random_range(0..3_u8) {
            0 => &mut motion.roll,
            1 => &mut motion.pitch,
            _ => &mut motion.heading,
        };
        jerk(grid, axis, at_s, stays_s, rises_s, angle);
        at_s += apart_s * draw.random_range(0.3..2.0);
    }
    motion
}
