//! Towed at sea: a swell spectrum drives heave, pitch and roll; legs with turns between.

use std::f64::consts::TAU;

use rand::RngExt;

use super::super::grid::Grid;
use super::super::tones::{Tone, band, rms, sum};
use super::course::{Depth, Motion};
use super::lake::legs;
use super::script::{degrees, oscillate};
use crate::random::Random;

/// Components of the spectrum.
const COMPONENTS: usize = 40;
/// Of free fall, m/s^2.
const GRAVITY: f64 = 9.81;

pub(super) fn draw(grid: &Grid, draw: &mut Random) -> Motion {
    let depth_m = draw.random_range(3.0..12.0);
    let waves = swell(1.0 / draw.random_range(4.5..10.0), draw.random_range(0.5..2.5), draw);
    // What is left of each at the body's depth, and the slope of the water there.
    let heave: Vec<Tone> = waves.iter().map(|tone| tone.times(libm::exp(-wavenumber(tone.hz) * depth_m))).collect();
    let slope: Vec<Tone> = heave.iter().map(|tone| tone.times(wavenumber(tone.hz)).behind()).collect();
    let mut sway = |range: [f64; 2], together: f64| {
        let target = degrees(range, draw);
        let shift = |tone: &Tone, draw: &mut Random| Tone {
            phase: tone.phase + together * draw.random_range(0.0..TAU),
            ..*tone
        };
        let tones: Vec<Tone> = slope.iter().map(|tone| shift(tone, draw)).collect();
        let scale = target / rms(&tones);
        let mut tones: Vec<Tone> = tones.into_iter().map(|tone| tone.times(scale)).collect();
        // The body's own wobble on its cable.
        tones.extend(band([0.3, 1.1], 10, 0.15 * target, draw));
        sum(grid, &tones)
    };
    let (mut roll, mut pitch, mut heading) = (sway([1.5, 5.0], 1.0), sway([1.0, 4.0], 0.0), sway([0.7, 2.5], 1.0));
    let wander = sum(grid, &band([0.005, 0.05], 6, degrees([0.5, 2.0], draw), draw));
    heading.iter_mut().zip(&wander).for_each(|(value, wander)| *value += wander);
    let has_manoeuvres = draw.random_bool(0.5);
    legs(grid, &mut heading, draw, |_, [from_s, to_s], _, draw| {
        if has_manoeuvres {
            let each_s = (to_s - from_s).min(60.0) / 2.0;
            oscillate(grid, &mut roll, from_s, from_s + each_s, draw.random_range(0.1..0.2), degrees([4.0, 9.0], draw));
            let hz = draw.random_range(0.1..0.2);
            oscillate(grid, &mut pitch, from_s + each_s, from_s + 2.0 * each_s, hz, degrees([3.0, 7.0], draw));
        }
    });
    let mut level_m = sum(grid, &band([0.001, 0.015], 6, draw.random_range(0.1..0.8), draw));
    level_m.iter_mut().for_each(|level| *level += depth_m);
    Motion { name: "sea", roll, pitch, heading, depth: Some(Depth::new(grid, &level_m, &heave)) }
}

/// Waves of deep water.
fn wavenumber(hz: f64) -> f64 {
    (TAU * hz).powi(2) / GRAVITY
}

/// Surface waves of a JONSWAP spectrum (Hasselmann et al. 1973) with this peak and significant height.
fn swell(peak_hz: f64, height_m: f64, draw: &mut Random) -> Vec<Tone> {
    let (low, high) = (0.6 * peak_hz, (4.0 * peak_hz).min(0.7));
    let width = (high - low) / COMPONENTS as f64;
    let peakedness = draw.random_range(1.0..4.0_f64);
    let tone = |k: usize, draw: &mut Random| {
        let hz = low + width * (k as f64 + draw.random::<f64>());
        let ratio = peak_hz / hz;
        let spread = if hz <= peak_hz { 0.07 } else { 0.09 };
        let near = libm::exp(-0.5 * ((hz / peak_hz - 1.0) / spread).powi(2));
        let density = ratio.powi(5) * libm::exp(-1.25 * ratio.powi(4)) * libm::pow(peakedness, near);
        Tone { hz, amplitude: density.sqrt(), phase: draw.random_range(0.0..TAU) }
    };
    let tones: Vec<Tone> = (0..COMPONENTS).map(|k| tone(k, draw)).collect();
    let scale = 0.25 * height_m / rms(&tones);
    tones.into_iter().map(|tone| tone.times(scale)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn swell_has_the_height_and_the_peak_that_it_is_asked_for() {
        let waves = swell(0.125, 2.0, &mut Random::seed_from_u64(1));
        assert!((4.0 * rms(&waves) - 2.0).abs() < 1e-9);
        let highest = waves.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap();
        assert!((highest.hz - 0.125).abs() < 0.03, "{}", highest.hz);
    }
}
