//! A position, and how far one may be off before it is none of the body's.

use crate::statistics::median;

/// A position at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fix {
    pub(crate) time_s: f64,
    /// Easting and northing, m.
    pub(crate) place_m: [f64; 2],
}

/// A fix is off by more than so many standard deviations of all: of 36,000 that are normal not one is.
const OFF_STD: f64 = 6.0;
/// And by more than this, m: what changing turns and the last digits of a coarse receiver (1e-5 degrees) do.
const OFF_M: f64 = 2.0;
/// From the median of the size of a two-dimensional normal deviate to one standard deviation of a component: sqrt(2 ln 2).
const RAYLEIGH_MEDIAN: f64 = 1.177_410_022_515_474_7;

/// By how much more than all others one must be off to be wrong, m; of how far each is off, whose order is lost.
pub(super) fn limit_m(off_m: &mut [f64]) -> f64 {
    OFF_M + OFF_STD * median(off_m).unwrap_or(0.0) / RAYLEIGH_MEDIAN
}
