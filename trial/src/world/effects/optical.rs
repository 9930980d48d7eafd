//! The scalar sensor's own axis: heading error and dead zone. And what the mains puts into it.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::World;
use super::super::grid::Grid;
use super::super::vector::{Vector, axis, dot};
use super::effect::{Act, Channel, Effect, Parameters, parameters};
use crate::random::Random;

pub(super) static EFFECTS: [Effect; 3] = [
    Effect {
        name: "heading_error",
        channel: Channel::Scalar,
        sizes: &["cubic_nT", "quartic_nT"],
        most: 40.0,
        draw: |_, draw| {
            let elevation_deg = libm::asin(draw.random_range(0.0..1.0)).to_degrees();
            Some(parameters([
                ("axis_azimuth_deg", draw.random_range(-180.0..180.0)),
                ("axis_elevation_deg", elevation_deg),
                ("cubic_nT", draw.random_range(-1.0..1.0)),
                ("quartic_nT", draw.random_range(-1.0..1.0)),
            ]))
        },
        act: Act::Scalar(|world, p, _| {
            let change = |u: f64| p["cubic_nT"] * u.powi(3) + p["quartic_nT"] * u.powi(4);
            along(world, p).into_iter().map(change).collect()
        }),
    },
    Effect {
        name: "dead_zone",
        channel: Channel::Scalar,
        sizes: &["noise_nT"],
        most: 20.0,
        draw: dead_zone,
        act: Act::Scalar(|world, p, draw| {
            let edge = libm::cos(p["half_angle_deg"].to_radians());
            let mut noise = |u: f64| {
                let unit: f64 = StandardNormal.sample(draw);
                if u.abs() >= edge { p["noise_nT"] * unit } else { 0.0 }
            };
            along(world, p).into_iter().map(&mut noise).collect()
        }),
    },
    Effect {
        name: "mains_alias",
        channel: Channel::Scalar,
        sizes: &["amplitude_nT"],
        most: 20.0,
        draw: |_, draw| {
            Some(parameters([
                ("frequency_hz", draw.random_range(0.12..4.9)),
                ("amplitude_nT", 0.1),
                ("phase_rad", draw.random_range(0.0..TAU)),
            ]))
        },
        act: Act::Scalar(|world, p, _| {
            let tone = |t: f64| p["amplitude_nT"] * libm::sin(TAU * p["frequency_hz"] * t + p["phase_rad"]);
            (0..world.rows()).map(|row| tone(Grid::row_s(row))).collect()
        }),
    },
];

fn axis_of(p: &Parameters) -> Vector {
    axis(p["axis_azimuth_deg"], p["axis_elevation_deg"])
}

/// Cosine between field and axis at the rows.
fn along(world: &World, p: &Parameters) -> Vec<f64> {
    let axis = axis_of(p);
    world.directions().into_iter().map(|direction| dot(direction, axis)).collect()
}

/// A zone that the body is in for a part of the time.
fn dead_zone(world: &World, draw: &mut Random) -> Option<Parameters> {
    for _ in 0..20 {
        let near = world.direction[Grid::of_row(draw.random_range(0..world.rows()))];
        let off: Vector = std::array::from_fn(|k| near[k] + draw.random_range(-0.4..0.4));
        let azimuth_deg = libm::atan2(off[1], off[0]).to_degrees();
        let elevation_deg = libm::atan2(off[2], libm::hypot(off[0], off[1])).to_degrees();
        let half_angle_deg = draw.random_range(6.0..30.0);
        let p = parameters([
            ("axis_azimuth_deg", azimuth_deg),
            ("axis_elevation_deg", elevation_deg),
            ("half_angle_deg", half_angle_deg),
            ("noise_nT", 0.1),
        ]);
        let edge = libm::cos(half_angle_deg.to_radians());
        let inside = along(world, &p).iter().filter(|u| u.abs() >= edge).count() as f64 / world.rows() as f64;
        if (0.05..0.7).contains(&inside) {
            return Some(p);
        }
    }
    None
}
