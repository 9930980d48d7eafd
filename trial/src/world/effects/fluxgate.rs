//! The fluxgate's errors.

use rand::RngExt;

use super::super::vector::Vector;
use super::super::{Last, World};
use super::effect::{Act, Channel, Effect, Parameters, any_vector, either_sign, parameters, vector};

pub(super) static EFFECTS: [Effect; 6] = [
    Effect {
        name: "fluxgate_bias",
        channel: Channel::Fluxgate,
        sizes: &["x_nT", "y_nT", "z_nT"],
        most: 150.0,
        draw: |_, draw| Some(any_vector("nT", draw)),
        act: Act::Fluxgate(|world, p| vec![vector(p, "nT"); world.rows()]),
    },
    Effect {
        name: "fluxgate_scale",
        channel: Channel::Fluxgate,
        sizes: &["x_ppm", "y_ppm", "z_ppm"],
        most: 5_000.0,
        draw: |_, draw| {
            let mut p = any_vector("ppm", draw);
            let mean = p.values().sum::<f64>() / 3.0;
            p.values_mut().for_each(|value| *value -= mean);
            Some(p)
        },
        act: Act::Fluxgate(|world, p| {
            let k = vector(p, "ppm");
            of_each(world, |f, _| std::array::from_fn(|i| 1e-6 * k[i] * f[i]))
        }),
    },
    Effect {
        name: "fluxgate_nonorthogonality",
        channel: Channel::Fluxgate,
        sizes: &["xy_mrad", "xz_mrad", "yz_mrad"],
        most: 15.0,
        draw: |_, draw| {
            Some(["xy_mrad", "xz_mrad", "yz_mrad"].map(|k| (k.into(), draw.random_range(-1.0..1.0))).into())
        },
        act: Act::Fluxgate(|world, p| {
            let [xy, xz, yz] = ["xy_mrad", "xz_mrad", "yz_mrad"].map(|name| 1e-3 * p[name]);
            of_each(world, |f, _| [0.0, xy * f[0], xz * f[0] + yz * f[1]])
        }),
    },
    Effect {
        name: "fluxgate_temperature_drift",
        channel: Channel::Fluxgate,
        sizes: &["x_nT_per_K", "y_nT_per_K", "z_nT_per_K"],
        most: 20.0,
        draw: |world, draw| world.columns.has_temperature.then(|| any_vector("nT_per_K", draw)),
        act: Act::Fluxgate(|world, p| {
            let k = vector(p, "nT_per_K");
            let warmer = warmer_k(world);
            of_each(world, |_, row| k.map(|k| k * warmer[row]))
        }),
    },
    Effect {
        name: "fluxgate_nonlinearity",
        channel: Channel::Fluxgate,
        sizes: &["cubic_ppm"],
        most: 3_000.0,
        draw: |_, draw| Some(parameters([("cubic_ppm", 100.0 * either_sign(draw))])),
        act: Act::Fluxgate(|world, p| {
            of_each(world, |f, _| f.map(|f| f * 1e-6 * p["cubic_ppm"] * (f / 50_000.0).powi(2)))
        }),
    },
    Effect {
        name: "fluxgate_quantisation",
        channel: Channel::Fluxgate,
        sizes: &["step_nT"],
        most: 60.0,
        draw: |_, _| Some(parameters([("step_nT", 3.0)])),
        act: Act::Last(|p: &Parameters| Last::Round(p["step_nT"])),
    },
];

fn of_each(world: &World, change: impl Fn(Vector, usize) -> Vector) -> Vec<Vector> {
    world.clean().flux_nt.into_iter().enumerate().map(|(row, f)| change(f, row)).collect()
}

/// Temperature less that of the first row, K.
pub(super) fn warmer_k(world: &World) -> Vec<f64> {
    let all = &world.columns.temperature_deg_c;
    all.iter().map(|temperature| temperature - all[0]).collect()
}
