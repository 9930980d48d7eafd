//! In flight: pitch, roll and yaw in series on four headings, as an aircraft is calibrated, and lines between banked turns.

use rand::RngExt;

use super::super::grid::Grid;
use super::super::tones::{band, sum};
use super::course::Motion;
use super::script::{degrees, oscillate, turn};
use crate::random::Random;

/// Headings of a calibration.
const HEADINGS: usize = 4;
/// Shortest stay on a heading, s.
const LEAST_STAY_S: f64 = 30.0;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    let wanted = (grid.duration_s() / draw.random_range(60.0..150.0)) as usize;
    let most = (grid.duration_s() / LEAST_STAY_S) as usize;
    let legs = wanted.max(HEADINGS).min(most.max(2));
    let leg_s = grid.duration_s() / legs as f64;
    let mut bumps = |rms: [f64; 2]| {
        let rms = degrees(rms, draw);
        let mut tones = band([0.3, 1.8], 20, 0.6 * rms, draw);
        tones.extend(band([0.03, 0.3], 8, rms, draw));
        sum(grid, &tones)
    };
    let (mut roll, mut pitch, mut heading) = (bumps([0.3, 1.2]), bumps([0.2, 0.7]), bumps([0.2, 0.8]));
    let first = draw.random_range(0.0..std::f64::consts::TAU);
    heading.iter_mut().for_each(|value| *value += first);
    let side = if draw.random_bool(0.5) { 1.0 } else { -1.0 };
    for leg in 0..legs {
        let start_s = leg as f64 * leg_s;
        let turn_s = draw.random_range(10.0..20.0_f64).min(0.4 * leg_s);
        if leg > 0 {
            turn(grid, &mut heading, start_s, turn_s, side * degrees([80.0, 100.0], draw));
            // Half a swing of a bank as long as the turn.
            oscillate(grid, &mut roll, start_s, start_s + turn_s, 0.5 / turn_s, side * degrees([15.0, 30.0], draw));
        }
        if leg >= HEADINGS && draw.random_bool(0.6) {
            continue;
        }
        let each_s = ((leg_s - turn_s) / 3.0).min(25.0);
        let mut from_s = start_s + turn_s;
        for (angle, range) in [(&mut pitch, [3.0, 6.0]), (&mut roll, [6.0, 12.0]), (&mut heading, [3.0, 6.0])] {
            let hz = draw.random_range(0.2..0.5);
            oscillate(grid, angle, from_s, from_s + each_s, hz, degrees(range, draw));
            from_s += each_s;
        }
    }
    Motion { name: "flight", roll, pitch, heading, depth: None }
}
