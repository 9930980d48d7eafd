//! What shape the spectrum of a sensor's noise may have: never rising with frequency, nor falling faster than that of a random
//! walk.
//!
//! White noise and rounding, noise of 1/f, what a first-order low-pass leaves of noise (AR(1)) and a random walk all keep to it, and so
//! does any sum of them. A band that stands out of all that those beside it allow is driven by something, however long it lasts:
//! the motion of the body, a current, a part that swings.

use crate::diagnosis::policy::{
    SPECTRUM_DIRECTION_ERROR, SPECTRUM_LEAST_REST, SPECTRUM_SHAPE_ERROR, SPECTRUM_SHAPE_SIGMAS, SPECTRUM_STEEPEST,
};

/// The level of a spectrum in one band.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Logarithm of Hz.
    pub(super) log_hz: f64,
    /// Logarithm of nT^2/Hz.
    pub(super) log_power: f64,
    /// Its standard error.
    pub(super) error: f64,
}

impl Knot {
    /// Without noise of a known power density, nT^2/Hz: the more of it that is, the less is known of the rest.
    pub(super) fn without(&self, known: f64) -> Self {
        let all = self.log_power.exp();
        let rest = (all - known).max(SPECTRUM_LEAST_REST * all);
        let error = (self.error * all).hypot(SPECTRUM_DIRECTION_ERROR * known) / rest;
        Self { log_power: rest.ln(), error, ..*self }
    }

    /// The largest level that noise may have at another frequency, if it has no more than this at its own, beyond any doubt about
    /// the levels of both.
    fn allows(&self, other: &Self) -> f64 {
        let fallen = SPECTRUM_STEEPEST * (self.log_hz - other.log_hz).max(0.0);
        let doubt = self.error.hypot(other.error).hypot(SPECTRUM_SHAPE_ERROR);
        self.log_power + fallen + SPECTRUM_SHAPE_SIGMAS * doubt
    }
}

/// The same knots, none above what all the others allow it.
pub(super) fn of_noise(knots: &[Knot]) -> Vec<Knot> {
    let allowed = |knot: &Knot| knots.iter().map(|other| other.allows(knot)).fold(knot.log_power, f64::min);
    knots.iter().map(|knot| Knot { log_power: allowed(knot), ..*knot }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knots(power: impl Fn(f64) -> f64) -> Vec<Knot> {
        (0..14)
            .map(|k| 0.09 * 1.35_f64.powi(k))
            .map(|hz| Knot { log_hz: hz.ln(), log_power: power(hz).ln(), error: 0.1 })
            .collect()
    }

    /// The largest share of its power that a band loses.
    fn lost(power: impl Fn(f64) -> f64) -> f64 {
        let knots = knots(power);
        let bounded = of_noise(&knots);
        knots.iter().zip(&bounded).map(|(a, b)| 1.0 - (b.log_power - a.log_power).exp()).fold(0.0, f64::max)
    }

    #[test]
    fn what_sensors_have_keeps_its_spectrum() {
        let ar1 =
            |keep: f64, hz: f64| 1.0 / (1.0 + keep * keep - 2.0 * keep * (std::f64::consts::TAU * hz / 10.0).cos());
        assert_eq!(lost(|_| 1.0), 0.0);
        assert_eq!(lost(|hz| 1.0 / hz), 0.0);
        assert_eq!(lost(|hz| 0.3 / (hz * hz) + 1.0), 0.0);
        for keep in [0.3, 0.9, 0.99] {
            assert_eq!(lost(|hz| ar1(keep, hz)), 0.0);
        }
    }

    #[test]
    fn a_hump_is_taken_off_and_so_is_what_falls_too_fast() {
        let hump = |hz: f64| 1.0 + 100.0 * (-(hz / 0.5).ln().powi(2) / 0.1).exp();
        assert!(lost(hump) > 0.95);
        assert!(lost(|hz| 1e-6 + hz.powi(-6)) > 0.9);
    }
}
