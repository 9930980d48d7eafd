//! Magnetic moments that the calibration does not know: one that has changed, one that warms, one of a current.

use rand::RngExt;

use super::super::World;
use super::super::grid::Grid;
use super::super::vector::{Vector, dot};
use super::effect::{Act, Channel, Effect, Parameters, any_vector, vector};
use super::fluxgate::warmer_k;
use crate::random::Random;

pub(super) static EFFECTS: [Effect; 3] = [
    Effect {
        name: "permanent_step",
        channel: Channel::Scalar,
        sizes: &["x_nT", "y_nT", "z_nT"],
        most: 150.0,
        draw: |world, draw| {
            let mut p = any_vector("nT", draw);
            let time_s = world.columns.first_time_s + world.grid.duration_s() * draw.random_range(0.15..0.85);
            p.insert("time_s".into(), time_s);
            Some(p)
        },
        act: Act::Scalar(|world, p, _| {
            let from_s = p["time_s"] - world.columns.first_time_s;
            along(world, vector(p, "nT"), |row| f64::from(u8::from(Grid::row_s(row) >= from_s - 1e-9)))
        }),
    },
    Effect {
        name: "permanent_temperature",
        channel: Channel::Scalar,
        sizes: &["x_nT_per_K", "y_nT_per_K", "z_nT_per_K"],
        most: 20.0,
        draw: |world, draw| world.columns.has_temperature.then(|| any_vector("nT_per_K", draw)),
        act: Act::Scalar(|world, p, _| {
            let warmer = warmer_k(world);
            along(world, vector(p, "nT_per_K"), |row| warmer[row])
        }),
    },
    Effect {
        name: "load_current",
        channel: Channel::Scalar,
        sizes: &["x_nT", "y_nT", "z_nT"],
        most: 60.0,
        draw: load,
        act: Act::Scalar(|world, p, _| {
            along(world, vector(p, "nT"), |row| match (p.get("period_s"), &world.columns.load) {
                (Some(period_s), _) => {
                    let cycles = Grid::row_s(row) / period_s + p["phase"];
                    f64::from(u8::from(cycles - cycles.floor() < p["duty"]))
                }
                (None, Some((_, current_a))) => current_a[row],
                (None, None) => 0.0,
            })
        }),
    },
];

/// A blinking load, or the one whose current is recorded.
fn load(world: &World, draw: &mut Random) -> Option<Parameters> {
    let mut p = any_vector("nT", draw);
    if world.columns.load.is_none() || draw.random_bool(0.3) {
        let period_s = 1.5 * libm::pow(40.0, draw.random::<f64>());
        p.insert("period_s".into(), period_s);
        p.insert("duty".into(), draw.random_range(0.15..0.85));
        p.insert("phase".into(), draw.random_range(0.0..1.0));
    }
    Some(p)
}

/// A moment along the field, at the rows.
fn along(world: &World, moment_nt: Vector, times: impl Fn(usize) -> f64) -> Vec<f64> {
    world.directions().into_iter().enumerate().map(|(row, c)| times(row) * dot(moment_nt, c)).collect()
}
