//! Parts of the body that are loose, or that are moved by the way it lies.

use rand::RngExt;

use super::super::super::grid::{FINE_HZ, Grid};
use super::super::super::{Change, World};
use super::super::mechanism::{Mechanism, driven, louder_with, mechanism};
use super::super::shape::{along, along_fine, any_moment, instants, standard, swing};
use crate::random::Random;

pub(super) static ALL: [Mechanism; 6] = [
    driven("sliding_ballast", &["attitude_history"], sliding_ballast),
    driven("pendulum_weight", &["attitude_history"], pendulum_weight),
    louder_with("chattering_plate", &["attitude"], chattering_plate),
    driven("rudder_with_dead_band", &["attitude_history"], rudder_with_dead_band),
    mechanism("ringing_antenna", ringing_antenna),
    driven("turning_bolt", &["attitude_history"], turning_bolt),
];

/// Ballast that slides between two stops once the pitch overcomes its friction.
fn sliding_ballast(world: &World, draw: &mut Random) -> Change {
    let pitch = standard(&world.motion.pitch);
    let place = sliding(&pitch, draw.random_range(0.5..1.2), 1.0 / draw.random_range(0.4..2.5));
    Change::of_scalar(along_fine(world, any_moment(draw), &place))
}

/// A weight that hangs free and swings when the body rolls.
fn pendulum_weight(world: &World, draw: &mut Random) -> Change {
    let roll = standard(&world.motion.roll);
    let swung = swing(&roll, draw.random_range(0.3..1.1), draw.random_range(0.03..0.15));
    let away: Vec<f64> = swung.iter().zip(&roll).map(|(swung, roll)| swung - roll).collect();
    Change::of_scalar(along_fine(world, any_moment(draw), &away))
}

/// A plate that chatters on its bolts while the body lies far over.
fn chattering_plate(world: &World, draw: &mut Random) -> Change {
    let roll = world.grid.at_rows(&standard(&world.motion.roll));
    let (edge, chance) = (draw.random_range(0.8..1.3), draw.random_range(0.2..0.6));
    let mut is_lifted = false;
    let mut next = |roll: &f64| {
        is_lifted = roll.abs() > edge && (is_lifted ^ draw.random_bool(chance));
        f64::from(u8::from(is_lifted))
    };
    let course: Vec<f64> = roll.iter().map(&mut next).collect();
    Change::of_scalar(along(world, any_moment(draw), &course))
}

/// A steel rudder that its servo moves at one speed, and only when the course is off by more than a dead band.
fn rudder_with_dead_band(world: &World, draw: &mut Random) -> Change {
    let heading = &world.motion.heading;
    let course = Grid::low_pass(heading, draw.random_range(5.0..20.0), &[]);
    let off: Vec<f64> = heading.iter().zip(&course).map(|(heading, course)| heading - course).collect();
    let rudder = servo(&standard(&off), draw.random_range(0.3..0.9), 1.0 / draw.random_range(0.7..3.0));
    Change::of_scalar(along_fine(world, any_moment(draw), &rudder))
}

/// A whip antenna of steel that rings whenever the cable snatches.
fn ringing_antenna(world: &World, draw: &mut Random) -> Change {
    let mut kicks = vec![0.0; world.grid.len()];
    for time_s in instants(world.grid.end_s(), draw.random_range(5.0..20.0), draw) {
        let at = ((time_s - world.grid.start_s()) * FINE_HZ) as usize;
        let end = (at + 10).min(kicks.len());
        kicks[at.min(end)..end].fill(draw.random_range(0.3..1.0));
    }
    let rung = swing(&kicks, draw.random_range(1.5..4.0), draw.random_range(0.01..0.05));
    Change::of_scalar(along_fine(world, any_moment(draw), &rung))
}

/// A bolt that turns by a part of a turn with every large roll, its moment with it.
fn turning_bolt(world: &World, draw: &mut Random) -> Change {
    let roll = standard(&world.motion.roll);
    let (edge, step) = (draw.random_range(0.8..1.4), draw.random_range(0.4..1.5));
    let turned = swept(&roll, edge);
    let (across, other) = (any_moment(draw), any_moment(draw));
    let part = |of: fn(f64) -> f64| -> Vec<f64> { turned.iter().map(|count| of(step * count)).collect() };
    let first = along_fine(world, across, &part(libm::cos));
    let second = along_fine(world, other, &part(libm::sin));
    Change::of_scalar(first.iter().zip(&second).map(|(a, b)| a + b).collect())
}

/// Between -1 and 1, at one speed while the slope is above the friction.
fn sliding(slope: &[f64], friction: f64, speed: f64) -> Vec<f64> {
    let mut place = 0.0_f64;
    let mut next = |slope: &f64| {
        if slope.abs() > friction {
            place = (place + slope.signum() * speed / FINE_HZ).clamp(-1.0, 1.0);
        }
        place
    };
    slope.iter().map(&mut next).collect()
}

/// Follows `wanted` at one speed, once it is off by more than the dead band and until it is there.
fn servo(wanted: &[f64], dead_band: f64, speed: f64) -> Vec<f64> {
    let (mut place, mut is_moving) = (0.0_f64, false);
    let mut next = |wanted: &f64| {
        let off = wanted - place;
        is_moving = off.abs() > dead_band || (is_moving && off.abs() > speed / FINE_HZ);
        if is_moving {
            place += off.clamp(-speed / FINE_HZ, speed / FINE_HZ);
        }
        place
    };
    wanted.iter().map(&mut next).collect()
}

/// How often `course` has gone above `edge`, after it was below zero.
fn swept(course: &[f64], edge: f64) -> Vec<f64> {
    let (mut count, mut is_armed) = (0.0, true);
    let mut next = |x: &f64| {
        if *x > edge && is_armed {
            (count, is_armed) = (count + 1.0, false);
        }
        is_armed |= *x < 0.0;
        count
    };
    course.iter().map(&mut next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ballast_slides_to_its_stop_and_stays_there_without_a_slope() {
        let slope = [vec![0.4; 100], vec![0.6; 300], vec![-0.4; 100], vec![-0.6; 100]].concat();
        let place = sliding(&slope, 0.5, 0.5);
        assert_eq!((place[99], place[399], place[499]), (0.0, 1.0, 1.0));
        assert!((place[599] - 0.5).abs() < 1e-9 && (place[199] - 0.5).abs() < 1e-9);
    }

    #[test]
    fn a_servo_waits_for_its_dead_band_and_then_goes_all_the_way() {
        let place = servo(&[vec![0.9; 50], vec![1.5; 400]].concat(), 1.0, 0.5);
        assert_eq!(place[49], 0.0);
        assert!((place[149] - 0.5).abs() < 1e-9 && (place[449] - 1.5).abs() < 0.01);
    }

    #[test]
    fn a_sweep_counts_once_until_it_was_below_zero() {
        assert_eq!(swept(&[0.0, 2.0, 0.5, 2.0, -0.1, 2.0], 1.0), [0.0, 1.0, 1.0, 1.0, 1.0, 2.0]);
    }
}
