//! Towed on a lake: small short waves, legs with turns between, manoeuvres on some of the legs.

use rand::RngExt;

use super::super::grid::Grid;
use super::super::tones::{band, sum};
use super::course::{Depth, Motion};
use super::script::{degrees, oscillate, turn};
use crate::random::Random;

/// Shortest leg, s.
const LEAST_LEG_S: f64 = 60.0;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    let peak_hz = draw.random_range(0.4..0.75);
    let mut sway = |rms: [f64; 2]| {
        let rms = degrees(rms, draw);
        let mut tones = band([0.8 * peak_hz, 1.6 * peak_hz], 16, rms, draw);
        tones.extend(band([0.03, 0.15], 5, 0.5 * rms, draw));
        sum(grid, &tones)
    };
    let (mut roll, mut pitch, mut heading) = (sway([1.0, 3.0]), sway([0.7, 2.0]), sway([0.5, 1.5]));
    legs(grid, &mut heading, draw, |leg, [from_s, to_s], heading, draw| {
        // Manoeuvres on the first legs, then straight lines.
        if leg > 1 && draw.random_bool(0.5) {
            return;
        }
        let each_s = (to_s - from_s).min(120.0) / 3.0;
        let mut start_s = from_s;
        for (angle, most) in [(&mut roll, 10.0), (&mut pitch, 7.0), (heading, 8.0)] {
            let hz = draw.random_range(0.1..0.25);
            oscillate(grid, angle, start_s, start_s + each_s, hz, degrees([0.5 * most, most], draw));
            start_s += each_s;
        }
    });
    let mut level_m = sum(grid, &band([0.002, 0.02], 6, draw.random_range(0.05..0.3), draw));
    let mean_m = draw.random_range(1.5..5.0);
    level_m.iter_mut().for_each(|level| *level += mean_m);
    let heave_m = draw.random_range(0.02..0.08);
    // Wind waves, and the wash of the boat.
    let mut waves = band([0.8 * peak_hz, 1.6 * peak_hz], 16, heave_m, draw);
    waves.extend(band([0.15, 0.45], 8, 0.5 * heave_m, draw));
    Motion { name: "lake", roll, pitch, heading, depth: Some(Depth::new(grid, &level_m, &waves)) }
}

/// Straight legs and turns between them; `on_leg` adds to each.
pub(super) fn legs(
    grid: &Grid,
    heading: &mut Vec<f64>,
    draw: &mut Random,
    mut on_leg: impl FnMut(usize, [f64; 2], &mut Vec<f64>, &mut Random),
) {
    let most = ((grid.duration_s() / LEAST_LEG_S) as usize).max(2);
    let count = draw.random_range(3..=6_usize).min(most);
    let leg_s = grid.duration_s() / count as f64;
    let first = draw.random_range(0.0..std::f64::consts::TAU);
    heading.iter_mut().for_each(|value| *value += first);
    for leg in 0..count {
        let start_s = leg as f64 * leg_s;
        let turn_s = draw.random_range(15.0..35.0_f64).min(0.4 * leg_s);
        if leg > 0 {
            let side = if draw.random_bool(0.7) { 1.0 } else { -1.0 };
            turn(grid, heading, start_s, turn_s, side * degrees([60.0, 150.0], draw));
        }
        on_leg(leg, [start_s + turn_s, start_s + leg_s], heading, draw);
    }
}
