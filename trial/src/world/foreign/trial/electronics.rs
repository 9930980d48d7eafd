//! The scalar sensor's electronics, and currents that nobody recorded.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::super::columns::motor_current_a;
use super::super::super::grid::Grid;
use super::super::super::{Change, World};
use super::super::mechanism::{Mechanism, driven, louder_with, mechanism};
use super::super::shape::{along, any_axis, any_moment, cosine, instants, standard, swing};
use crate::random::Random;

pub(super) static ALL: [Mechanism; 8] = [
    driven("servo_overshoot", &["reading"], servo_overshoot),
    louder_with("agc_ripple", &["attitude"], agc_ripple),
    driven("counter_gate_beat", &["reading"], counter_gate_beat),
    driven("rectified_slew", &["reading"], rectified_slew),
    driven("saturating_amplifier", &["reading"], saturating_amplifier),
    driven("heading_synchro", &["attitude"], heading_synchro),
    mechanism("lost_lock", lost_lock),
    mechanism("unrecorded_motor", unrecorded_motor),
];

/// A loop that follows the field and overshoots; its mean delay is corrected for, the ringing is left.
fn servo_overshoot(world: &World, draw: &mut Random) -> Change {
    let (hz, damping) = (draw.random_range(1.0..2.5), draw.random_range(0.08..0.3));
    let followed = swing(&deviation(world), hz, damping);
    let late_s = 2.0 * damping / (TAU * hz);
    let change = |row: usize| {
        let (truth, t) = (world.scalar_nt[Grid::of_row(row)] - world.scalar_nt[0], Grid::row_s(row));
        world.grid.at(&followed, t + late_s) - truth
    };
    Change::of_scalar((0..world.rows()).map(change).collect())
}

/// A gain control that lets a wandering ripple through, the more the farther the field is from its best angle.
fn agc_ripple(world: &World, draw: &mut Random) -> Change {
    let angle = world.grid.at_rows(&standard(&cosine(world, any_axis(draw))));
    let (middle_hz, mut off_hz, mut cycles) = (draw.random_range(0.8..4.0), 0.0, 0.0);
    let mut next = |angle: &f64| {
        let normal: f64 = StandardNormal.sample(draw);
        off_hz = 0.99 * off_hz + 0.003 * normal * middle_hz;
        cycles += (middle_hz + off_hz) / 10.0;
        angle * libm::sin(TAU * cycles)
    };
    Change::of_scalar(angle.iter().map(&mut next).collect())
}

/// The counter's gate beats with the Larmor frequency: an error that goes round and round as the field changes.
fn counter_gate_beat(world: &World, draw: &mut Random) -> Change {
    let field = world.grid.at_rows(&standard(&deviation(world)));
    let (turns, start) = (draw.random_range(0.6..2.0), draw.random_range(0.0..1.0));
    Change::of_scalar(field.iter().map(|x| beat(turns * x + start)).collect())
}

/// A detector that reads high whenever the field moves, whichever way.
fn rectified_slew(world: &World, _: &mut Random) -> Change {
    let rate = world.grid.at_rows(&Grid::derivative(&world.scalar_nt));
    Change::of_scalar(rate.iter().map(|rate| rate.abs()).collect())
}

/// An amplifier that cuts off large swings of the field.
fn saturating_amplifier(world: &World, draw: &mut Random) -> Change {
    let deviation = deviation(world);
    let slow = Grid::low_pass(&deviation, 30.0, &[]);
    let fast: Vec<f64> = deviation.iter().zip(&slow).map(|(x, slow)| x - slow).collect();
    let knee = draw.random_range(0.7..1.4);
    Change::of_scalar(world.grid.at_rows(&standard(&fast)).iter().map(|x| x.clamp(-knee, knee) - x).collect())
}

/// The synchro of a heading gyro: geared up, its moment goes round many times in one turn of the body.
fn heading_synchro(world: &World, draw: &mut Random) -> Change {
    let (gear, start) = (f64::from(draw.random_range(9..=36_u8)), draw.random_range(0.0..TAU));
    let course: Vec<f64> = world.motion.heading.iter().map(|heading| libm::sin(gear * heading + start)).collect();
    Change::of_scalar(along(world, any_moment(draw), &world.grid.at_rows(&course)))
}

/// A sensor that loses its lock now and then and comes back slowly, without a flag.
fn lost_lock(world: &World, draw: &mut Random) -> Change {
    let (apart_s, back_s) = (draw.random_range(10.0..40.0), draw.random_range(0.7..3.0));
    let mut change = vec![0.0; world.rows()];
    for time_s in instants(world.grid.duration_s(), apart_s, draw) {
        let height = draw.random_range(0.3..1.0) * if draw.random_bool(0.5) { 1.0 } else { -1.0 };
        recover(&mut change, time_s, height, back_s);
    }
    Change::of_scalar(change)
}

/// A motor whose current is not recorded: levels without a rhythm, each with its inrush.
fn unrecorded_motor(world: &World, draw: &mut Random) -> Change {
    let current_a = motor_current_a(world.rows(), draw);
    Change::of_scalar(along(world, any_moment(draw), &current_a))
}

/// The scalar less its first value.
fn deviation(world: &World) -> Vec<f64> {
    world.scalar_nt.iter().map(|nt| nt - world.scalar_nt[0]).collect()
}

/// A saw tooth from -1 to 1.
fn beat(turns: f64) -> f64 {
    2.0 * (turns - turns.floor()) - 1.0
}

/// Adds a jump that dies away.
fn recover(change: &mut [f64], time_s: f64, height: f64, back_s: f64) {
    for (row, value) in change.iter_mut().enumerate() {
        let since_s = Grid::row_s(row) - time_s;
        if (0.0..20.0 * back_s).contains(&since_s) {
            *value += height * libm::exp(-since_s / back_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_dies_away_with_its_time_constant_and_a_beat_goes_round() {
        let mut change = vec![0.0; 60];
        recover(&mut change, 1.0, 2.0, 1.5);
        assert_eq!((change[9], change[10]), (0.0, 2.0));
        assert!((change[25] - 2.0 * (-1.0_f64).exp()).abs() < 1e-12);
        assert_eq!([0.0, 0.25, 0.75, 1.25, -0.25].map(beat), [-1.0, -0.5, 0.5, -0.5, 0.5]);
    }
}
