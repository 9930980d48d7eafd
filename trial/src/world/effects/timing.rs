//! When the scalar is read: late, early, again, or for how long. None of them reaches across a gap.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::grid::Grid;
use super::super::{Last, World};
use super::effect::{Act, Channel, Effect, Parameters, either_sign, parameters};
use crate::random::Random;

const fn effect(
    name: &'static str,
    sizes: &'static [&'static str],
    most: f64,
    draw: fn(&World, &mut Random) -> Option<Parameters>,
    act: Act,
) -> Effect {
    Effect { name, channel: Channel::Scalar, sizes, most, draw, act }
}

pub(super) static EFFECTS: [Effect; 7] = [
    effect(
        "scalar_lag",
        &["lag_s"],
        0.4,
        |_, draw| Some(parameters([("lag_s", 0.05 * either_sign(draw))])),
        Act::Scalar(|world, p, _| read_late(world, |_, _| p["lag_s"])),
    ),
    effect(
        "clock_drift",
        &["rate_ppm"],
        400.0,
        |_, draw| Some(parameters([("rate_ppm", 30.0 * either_sign(draw))])),
        Act::Scalar(|world, p, _| read_late(world, |_, t| 1e-6 * p["rate_ppm"] * t)),
    ),
    effect(
        "sample_slip",
        &[],
        0.0,
        slip,
        Act::Scalar(|world, p, _| {
            let from_s = p["time_s"] - world.columns.first_time_s;
            read_late(world, |_, t| if t >= from_s - 1e-9 { 0.1 * p["samples"] } else { 0.0 })
        }),
    ),
    effect(
        "sample_jitter",
        &["sigma_s"],
        0.04,
        |_, _| Some(parameters([("sigma_s", 0.003)])),
        Act::Scalar(|world, p, draw| {
            let errors: Vec<f64> = (0..world.rows()).map(|_| StandardNormal.sample(draw)).collect();
            read_late(world, |row, _| p["sigma_s"] * errors[row])
        }),
    ),
    effect(
        "stale_sample",
        &["probability"],
        0.2,
        |_, _| Some(parameters([("probability", 0.01)])),
        Act::Last(|p| Last::Repeat(p["probability"])),
    ),
    effect(
        "averaging_window",
        &["window_s"],
        0.6,
        |_, _| Some(parameters([("window_s", 0.1)])),
        Act::Scalar(|world, p, _| average(world, p["window_s"])),
    ),
    effect(
        "scalar_lowpass",
        &["time_constant_s"],
        0.5,
        |_, _| Some(parameters([("time_constant_s", 0.05)])),
        Act::Scalar(|world, p, _| low_pass(world, p["time_constant_s"])),
    ),
];

fn slip(world: &World, draw: &mut Random) -> Option<Parameters> {
    let time_s = world.columns.first_time_s + world.grid.duration_s() * draw.random_range(0.15..0.9);
    let samples = f64::from(draw.random_range(1..=4_u8)) * either_sign(draw);
    Some(parameters([("time_s", time_s), ("samples", samples)]))
}

/// Earliest and latest instant that each row may be read at, s.
fn reaches(world: &World) -> Vec<[f64; 2]> {
    let segments = world.columns.segments(world.rows());
    let mut all = vec![[0.0; 2]; world.rows()];
    for segment in &segments {
        // Before the first row and after the last one the world goes on.
        let from_s = if segment.start == 0 { world.grid.start_s() + 0.1 } else { Grid::row_s(segment.start) };
        let to_s = if segment.end == world.rows() { world.grid.end_s() - 0.1 } else { Grid::row_s(segment.end - 1) };
        all[segment.clone()].fill([from_s, to_s]);
    }
    all
}

/// What comes of reading the scalar `late_s(row, t)` late.
pub(in crate::world) fn read_late(world: &World, late_s: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    let change = |(row, [from_s, to_s]): (usize, [f64; 2])| {
        let t = Grid::row_s(row);
        let at_s = (t - late_s(row, t)).clamp(from_s.min(t), to_s.max(t));
        world.grid.at(&world.scalar_nt, at_s) - world.scalar_nt[Grid::of_row(row)]
    };
    reaches(world).into_iter().enumerate().map(change).collect()
}

fn average(world: &World, window_s: f64) -> Vec<f64> {
    let integral = Grid::integral(&offset(world));
    let change = |(row, [from_s, _]): (usize, [f64; 2])| {
        let t = Grid::row_s(row);
        let from_s = (t - window_s).max(from_s.min(t));
        if t - from_s < 1e-6 {
            return 0.0;
        }
        let mean = (world.grid.at(&integral, t) - world.grid.at(&integral, from_s)) / (t - from_s);
        mean + world.scalar_nt[0] - world.scalar_nt[Grid::of_row(row)]
    };
    reaches(world).into_iter().enumerate().map(change).collect()
}

fn low_pass(world: &World, time_constant_s: f64) -> Vec<f64> {
    let segments = world.columns.segments(world.rows());
    let restarts: Vec<usize> = segments.iter().skip(1).map(|rows| Grid::of_row(rows.start)).collect();
    let fine = offset(world);
    let filtered = Grid::low_pass(&fine, time_constant_s, &restarts);
    (0..world.rows()).map(Grid::of_row).map(|at| filtered[at] - fine[at]).collect()
}

/// The scalar less its first value: sums of it keep their digits.
fn offset(world: &World) -> Vec<f64> {
    world.scalar_nt.iter().map(|nt| nt - world.scalar_nt[0]).collect()
}
