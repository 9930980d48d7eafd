//! The Earth's field along the way: a strength, an inclination, and geology and the day's change below 0.02 Hz.

use rand::RngExt;

use super::grid::Grid;
use super::tones::{Tone, rms, sum};
use super::vector::Vector;
use crate::random::{Random, log_uniform};

/// Tones of the slow part.
const TONES: usize = 24;
/// Where the slow part ends, Hz.
const END_HZ: f64 = 0.018;

pub(super) struct Earth {
    /// Unit vector north, east, down.
    pub(super) direction: Vector,
    /// At 100 Hz, nT.
    pub(super) field_nt: Vec<f64>,
}

pub(super) fn draw(grid: &Grid, is_land: bool, draw: &mut Random) -> Earth {
    let inclination: f64 = draw.random_range(-78.0..78.0_f64).to_radians();
    let (sin, cos) = libm::sincos(inclination);
    let mean_nt = draw.random_range(25_000.0..60_000.0);
    let mut slow = geology(if is_land { [0.3, 3.0] } else { [2.0, 40.0] }, draw);
    // A diurnal change that the recording sees a piece of.
    slow.push(Tone { hz: 1.0 / 43_200.0, amplitude: 15.0, phase: draw.random_range(0.0..std::f64::consts::TAU) });
    let field_nt = sum(grid, &slow).into_iter().map(|nt| mean_nt + nt).collect();
    Earth { direction: [cos, 0.0, sin], field_nt }
}

/// Stronger where it is slower.
fn geology(rms_nt: [f64; 2], draw: &mut Random) -> Vec<Tone> {
    let target_nt = log_uniform(rms_nt, draw);
    let lowest_hz = 0.0005;
    let tone = |k: usize, draw: &mut Random| {
        let share = (k as f64 + draw.random::<f64>()) / TONES as f64;
        let hz = lowest_hz * libm::pow(END_HZ / lowest_hz, share);
        // Even in the logarithm of frequency: power as f^-3 and less.
        let amplitude = libm::pow(hz / lowest_hz, -1.5) * draw.random_range(0.3..1.0);
        Tone { hz, amplitude, phase: draw.random_range(0.0..std::f64::consts::TAU) }
    };
    let tones: Vec<Tone> = (0..TONES).map(|k| tone(k, draw)).collect();
    let scale = target_nt / rms(&tones);
    tones.into_iter().map(|tone| tone.times(scale)).collect()
}
