//! A recording's track as a simulator of somebody's own would have it: the clean world at another rate and by another clock, without
//! effects, targets and noise.

use std::fmt::Write;

use rand::RngExt;

use super::grid::FINE_HZ;
use super::state::World;
use super::vector::scaled;
use crate::random::Random;

/// Samples of the world from one row to the next: 14.3 Hz, no multiple of the recording's.
const STRIDE: usize = 7;
/// By how much the clock may be ahead or behind, s.
const CLOCK_S: f64 = 50.0;

/// As a CSV file.
pub(crate) fn simulation(world: &World, draw: &mut Random) -> String {
    let ahead_s = world.columns.first_time_s + CLOCK_S * draw.random_range(-1.0..1.0);
    let first = draw.random_range(0..STRIDE);
    let mut csv = String::from("time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT\n");
    for at in (first..world.grid.len()).step_by(STRIDE) {
        let time_s = world.grid.start_s() + at as f64 / FINE_HZ + ahead_s;
        let [x, y, z] = scaled(world.direction[at], world.field_nt[at]);
        let row = writeln!(csv, "{time_s:.4},{:.5},{x:.4},{y:.4},{z:.4}", world.scalar_nt[at]);
        debug_assert!(row.is_ok(), "memory");
    }
    csv
}
