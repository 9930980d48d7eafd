//! The ship and the sea, in one sensor or in both.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::super::grid::Grid;
use super::super::super::tones::{band, sum};
use super::super::super::vector::{Vector, dot, length, scaled};
use super::super::super::{Change, World};
use super::super::mechanism::{Mechanism, driven, mechanism};
use super::super::shape::{any_axis, instants, standard};
use crate::random::Random;

pub(super) static ALL: [Mechanism; 5] = [
    mechanism("ship_steel", ship_steel),
    mechanism("engine_under_load", engine_under_load),
    mechanism("propeller_alias", propeller_alias),
    mechanism("cathodic_protection", cathodic_protection),
    driven("steep_swell", &["depth", "depth_rate"], steep_swell),
];

/// The ship's steel, nearer and farther as the cable surges, and swinging as the ship yaws.
fn ship_steel(world: &World, draw: &mut Random) -> Change {
    let yaw = sum(&world.grid, &band([0.05, 0.15], 6, draw.random_range(3.0..8.0_f64).to_radians(), draw));
    let range = sum(&world.grid, &band([0.06, 0.25], 8, draw.random_range(0.01..0.05), draw));
    let (moment, earth) = (any_axis(draw), any_axis(draw));
    let at = |(yaw, range): (&f64, &f64)| {
        let (sin, cos) = libm::sincos(*yaw);
        dipole_nt(moment, earth, scaled([cos, sin, -0.2], 1.0 + range))
    };
    let course: Vec<f64> = yaw.iter().zip(&range).map(at).collect();
    in_both(world, world.grid.at_rows(&course))
}

/// An engine whose speed gives way when the load grows, and that is now and then set to another.
fn engine_under_load(world: &World, draw: &mut Random) -> Change {
    let load = world.grid.at_rows(&standard(&world.motion.pitch));
    let sets = instants(world.grid.duration_s(), draw.random_range(20.0..60.0), draw);
    let (middle_hz, gives) = (draw.random_range(0.4..3.5), draw.random_range(0.03..0.1));
    let (mut cycles, mut set, mut count) = (0.0, 1.0, 0);
    let mut next = |(row, load): (usize, &f64)| {
        let now = sets.partition_point(|at| *at <= Grid::row_s(row));
        if now != count {
            (count, set) = (now, draw.random_range(0.8..1.25));
        }
        cycles += middle_hz * set * (1.0 - gives * load) / 10.0;
        libm::sin(TAU * cycles)
    };
    Change::of_scalar(load.iter().enumerate().map(&mut next).collect())
}

/// Blades that pass many times a second, read ten times a second: a tone that sweeps to and fro over the whole band.
fn propeller_alias(world: &World, draw: &mut Random) -> Change {
    let middle_hz = draw.random_range(7.0..23.0);
    let (mut off_hz, mut cycles) = (0.0, 0.0);
    let mut next = |_| {
        let normal: f64 = StandardNormal.sample(draw);
        off_hz = 0.997 * off_hz + 0.08 * normal;
        cycles += (middle_hz + off_hz) / 10.0;
        libm::sin(TAU * cycles)
    };
    Change::of_scalar((0..world.rows()).map(&mut next).collect())
}

/// The ship's cathodic protection, whose current is set anew now and then and takes seconds to get there.
fn cathodic_protection(world: &World, draw: &mut Random) -> Change {
    let sets = instants(world.grid.duration_s(), draw.random_range(4.0..15.0), draw);
    let levels: Vec<f64> = (0..=sets.len()).map(|_| draw.random::<f64>()).collect();
    let fine: Vec<f64> = world.grid.times_s().map(|t| levels[sets.partition_point(|at| *at <= t)]).collect();
    let settled = Grid::low_pass(&fine, draw.random_range(0.3..2.0), &[]);
    in_both(world, world.grid.at_rows(&settled))
}

/// Currents in waves so steep that they go with the product of height and speed: twice as often as the swell.
fn steep_swell(world: &World, _: &mut Random) -> Change {
    let Some(depth) = &world.motion.depth else { return Change::default() };
    let slow = Grid::low_pass(&depth.depth_m, 15.0, &[]);
    let fine = depth.depth_m.iter().zip(&slow).zip(&depth.behind_m).map(|((z, slow), behind)| (z - slow) * behind);
    Change::of_scalar(world.grid.at_rows(&fine.collect::<Vec<f64>>()))
}

/// A dipole's field along the Earth's, at a place as seen from it.
fn dipole_nt(moment: Vector, earth: Vector, place: Vector) -> f64 {
    let distance = length(place);
    let unit = scaled(place, 1.0 / distance);
    (3.0 * dot(moment, unit) * dot(unit, earth) - dot(moment, earth)) / distance.powi(3)
}

/// A change of the field itself.
fn in_both(world: &World, scalar_nt: Vec<f64>) -> Change {
    let flux_nt = world.directions().iter().zip(&scalar_nt).map(|(c, nt)| scaled(*c, *nt)).collect();
    Change { scalar_nt, flux_nt }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dipole_is_twice_as_strong_ahead_as_abeam_and_falls_with_the_third_power() {
        let (ahead, abeam) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        assert_eq!((dipole_nt(ahead, ahead, ahead), dipole_nt(ahead, ahead, abeam)), (2.0, -1.0));
        assert_eq!(dipole_nt(ahead, ahead, scaled(ahead, 2.0)), 0.25);
    }
}
