//! A sea of a standard spectrum, as a body on a track meets it.

use std::f64::consts::TAU;

use rand::RngExt;

use super::WaveSpectrum;
use crate::effects::Draw;

/// Components of a sea.
const COMPONENTS: usize = 40;
/// Frequencies that hold nearly all of the energy, in peaks of the spectrum.
const BAND: [f64; 2] = [0.6, 3.0];
/// Half the fan of directions that waves come in, rad.
const FAN: f64 = 0.6;
/// Acceleration of gravity, m/s^2.
const GRAVITY: f64 = 9.81;
/// Peak enhancement of the JONSWAP spectrum.
const ENHANCEMENT: f64 = 3.3;

/// Waves of deep water.
pub(super) struct Sea {
    components: Vec<Component>,
}

struct Component {
    amplitude_m: f64,
    omega: f64,
    /// Wave number, 1/m, towards north and east.
    k: [f64; 2],
    phase: f64,
}

/// What a body meets: the surface, and its slopes along and across a heading.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Met {
    /// Surface above its mean, m.
    pub(super) elevation_m: f64,
    /// Slope ahead.
    pub(super) slope_ahead: f64,
    /// Slope to starboard.
    pub(super) slope_starboard: f64,
    /// A quarter period off the slope to starboard.
    pub(super) sway: f64,
}

impl Sea {
    /// A sea of a significant height and peak period that comes from a direction, degrees from north by east.
    pub(super) fn new(
        spectrum: WaveSpectrum,
        significant_height_m: f64,
        peak_period_s: f64,
        from_deg: f64,
        draw: &mut Draw,
    ) -> Self {
        let [low, high] = BAND;
        let width = (high - low) / COMPONENTS as f64;
        let mut components: Vec<_> = (0..COMPONENTS)
            .map(|n| {
                let ratio = low + width * (n as f64 + draw.random::<f64>());
                let omega = TAU * ratio / peak_period_s;
                let towards = (from_deg + 180.0).to_radians() + FAN * (2.0 * draw.random::<f64>() - 1.0);
                let (sin, cos) = libm::sincos(towards);
                let number = omega * omega / GRAVITY;
                let amplitude_m = (2.0 * density(spectrum, ratio) * width).sqrt();
                let k = [number * cos, number * sin];
                Component { amplitude_m, omega, k, phase: TAU * draw.random::<f64>() }
            })
            .collect();
        let variance: f64 = components.iter().map(|c| 0.5 * c.amplitude_m * c.amplitude_m).sum();
        // Significant height: four times the standard deviation of the surface.
        let scale = significant_height_m / (4.0 * variance.sqrt());
        components.iter_mut().for_each(|c| c.amplitude_m *= scale);
        Self { components }
    }

    /// What is met at a time at a place (m north and east) on a heading (rad).
    pub(super) fn meet(&self, time_s: f64, [north_m, east_m]: [f64; 2], heading: f64) -> Met {
        let (sin_heading, cos_heading) = libm::sincos(heading);
        let mut met = Met::default();
        for Component { amplitude_m, omega, k, phase } in &self.components {
            let (sin, cos) = libm::sincos(k[0] * north_m + k[1] * east_m - omega * time_s + phase);
            let ahead = k[0] * cos_heading + k[1] * sin_heading;
            let starboard = k[1] * cos_heading - k[0] * sin_heading;
            met.elevation_m += amplitude_m * cos;
            met.slope_ahead -= amplitude_m * ahead * sin;
            met.slope_starboard -= amplitude_m * starboard * sin;
            met.sway += amplitude_m * starboard * cos;
        }
        met
    }
}

/// Shape of the spectrum over frequency in peaks: `x^-5 exp(-1.25 x^-4)`, and what enhances the peak.
fn density(spectrum: WaveSpectrum, x: f64) -> f64 {
    let base = libm::pow(x, -5.0) * libm::exp(-1.25 * libm::pow(x, -4.0));
    match spectrum {
        WaveSpectrum::PiersonMoskowitz => base,
        WaveSpectrum::Jonswap => {
            let width = if x <= 1.0 { 0.07 } else { 0.09 };
            let off = (x - 1.0) / width;
            base * libm::pow(ENHANCEMENT, libm::exp(-0.5 * off * off))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_height_is_significant_and_the_slope_is_the_surface_s() {
        let sea = Sea::new(WaveSpectrum::Jonswap, 1.5, 7.0, 200.0, &mut Draw::seed_from_u64(1));
        let heading = 0.4_f64;
        let (mut sum, count) = (0.0, 200_000);
        for k in 0..count {
            sum += sea.meet(f64::from(k) * 0.1, [0.0; 2], heading).elevation_m.powi(2);
        }
        assert!((4.0 * (sum / f64::from(count)).sqrt() / 1.5 - 1.0).abs() < 0.03);
        let at = |along: f64| sea.meet(3.0, [along * heading.cos(), along * heading.sin()], heading);
        let slope = (at(1e-3).elevation_m - at(-1e-3).elevation_m) / 2e-3;
        assert!((at(0.0).slope_ahead - slope).abs() < 1e-6);
    }

    #[test]
    fn both_spectra_have_their_peak_at_one() {
        for spectrum in [WaveSpectrum::Jonswap, WaveSpectrum::PiersonMoskowitz] {
            let peak = (50..300).max_by(|a, b| {
                let of = |n: &i32| density(spectrum, f64::from(*n) / 100.0);
                of(a).total_cmp(&of(b))
            });
            assert_eq!(peak, Some(100));
        }
    }
}
