//! What mechanisms are made of: moments along the field, swings, parts that take up play.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::World;
use super::super::grid::FINE_HZ;
use super::super::vector::{Vector, dot, length, scaled};
use crate::random::Random;

/// Steps of a swing from one sample to the next.
const SWING_STEPS: usize = 8;

pub(super) fn any_moment(draw: &mut Random) -> Vector {
    std::array::from_fn(|_| draw.random_range(-1.0..1.0))
}

/// Of unit length.
pub(super) fn any_axis(draw: &mut Random) -> Vector {
    let any: Vector = std::array::from_fn(|_| StandardNormal.sample(draw));
    scaled(any, 1.0 / length(any))
}

/// A moment along the field, as many times as large at each row.
pub(super) fn along(world: &World, moment: Vector, course: &[f64]) -> Vec<f64> {
    world.directions().iter().zip(course).map(|(c, times)| times * dot(moment, *c)).collect()
}

/// The same of a course at 100 Hz.
pub(super) fn along_fine(world: &World, moment: Vector, course: &[f64]) -> Vec<f64> {
    along(world, moment, &world.grid.at_rows(course))
}

/// The field along an axis, at 100 Hz.
pub(super) fn cosine(world: &World, axis: Vector) -> Vec<f64> {
    world.direction.iter().map(|&c| dot(c, axis)).collect()
}

/// Without its mean and with unit rms; zero where nothing changes.
pub(super) fn standard(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let rms = (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64).sqrt();
    values.iter().map(|x| if rms > 0.0 { (x - mean) / rms } else { 0.0 }).collect()
}

/// Follows `drive` only once that has taken up the play.
pub(super) fn with_play(drive: &[f64], play: f64) -> Vec<f64> {
    let mut at = drive.first().copied().unwrap_or(0.0);
    let mut next = |&x: &f64| {
        at = at.clamp(x - play, x + play);
        at
    };
    drive.iter().map(&mut next).collect()
}

/// A damped swing about `drive`, both at 100 Hz: its own frequency, and its damping over the critical one.
pub(super) fn swing(drive: &[f64], hz: f64, damping: f64) -> Vec<f64> {
    let (omega, step_s) = (std::f64::consts::TAU * hz, 1.0 / (FINE_HZ * SWING_STEPS as f64));
    let (mut at, mut speed) = (drive.first().copied().unwrap_or(0.0), 0.0);
    let mut next = |&goal: &f64| {
        for _ in 0..SWING_STEPS {
            speed += step_s * (omega * omega * (goal - at) - 2.0 * damping * omega * speed);
            at += step_s * speed;
        }
        at
    };
    drive.iter().map(&mut next).collect()
}

/// Instants between 0 and `duration_s`, that far apart in the mean, at random.
pub(super) fn instants(duration_s: f64, apart_s: f64, draw: &mut Random) -> Vec<f64> {
    let mut all = Vec::new();
    let mut time_s = 0.0;
    loop {
        time_s -= apart_s * libm::log(1.0 - draw.random::<f64>());
        if time_s >= duration_s {
            return all;
        }
        all.push(time_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_is_taken_up_before_anything_moves() {
        assert_eq!(with_play(&[0.0, 0.5, 2.0, 1.5, -1.0], 1.0), [0.0, 0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_swing_overshoots_a_step_as_its_damping_says() {
        let mut step = vec![1.0; 2000];
        step[0] = 0.0;
        let most = swing(&step, 0.7, 0.2).into_iter().fold(0.0, f64::max);
        let exact = 1.0 + (-std::f64::consts::PI * 0.2 / (1.0 - 0.04_f64).sqrt()).exp();
        assert!((most - exact).abs() < 5e-3, "{most} {exact}");
    }

    #[test]
    fn a_standard_course_has_no_mean_and_unit_rms() {
        assert_eq!(standard(&[1.0, 3.0]), [-1.0, 1.0]);
        assert_eq!(standard(&[2.0, 2.0]), [0.0, 0.0]);
    }
}
