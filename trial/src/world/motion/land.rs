//! On land: the body rocked by hand about each axis on several headings, and shaken on some of them.

use rand::RngExt;

use super::super::grid::Grid;
use super::super::tones::{band, sum};
use super::course::Motion;
use super::script::{degrees, oscillate, turn};
use crate::random::Random;

/// Shortest stay on a heading, s.
const LEAST_STAY_S: f64 = 40.0;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    let most = ((grid.duration_s() / LEAST_STAY_S) as usize).max(2);
    let headings = draw.random_range(4..=8_usize).min(most);
    let stay_s = grid.duration_s() / headings as f64;
    let is_shaken = draw.random_bool(0.5);
    // A hand is never quite still.
    let mut still = |rms: f64| sum(grid, &band([0.1, 1.4], 12, rms.to_radians(), draw));
    let (mut roll, mut pitch, mut heading) = (still(0.15), still(0.15), still(0.2));
    let first = draw.random_range(0.0..std::f64::consts::TAU);
    heading.iter_mut().for_each(|value| *value += first);
    for station in 0..headings {
        let start_s = station as f64 * stay_s;
        let turn_s = draw.random_range(7.0..12.0_f64).min(0.3 * stay_s);
        if station > 0 {
            let angle = (360.0 / headings as f64).to_radians() + degrees([-8.0, 8.0], draw);
            turn(grid, &mut heading, start_s, turn_s, angle);
        }
        let shake_s = if is_shaken { 0.2 * stay_s } else { 0.0 };
        let each_s = (stay_s - turn_s - shake_s) / 3.0;
        let mut from_s = start_s + turn_s;
        for (angle, most) in [(&mut roll, 25.0), (&mut pitch, 20.0), (&mut heading, 20.0)] {
            let hz = draw.random_range(0.12..0.3);
            oscillate(grid, angle, from_s, from_s + each_s, hz, degrees([0.4 * most, most], draw));
            from_s += each_s;
        }
        if is_shaken {
            let hz = draw.random_range(0.8..1.2);
            for angle in [&mut roll, &mut pitch] {
                oscillate(grid, angle, from_s, from_s + shake_s, hz, degrees([1.5, 4.0], draw));
            }
        }
    }
    Motion { name: "land", roll, pitch, heading, depth: None }
}
