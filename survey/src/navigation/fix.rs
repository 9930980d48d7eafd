//! A position, and how far one may be off before it is none of the body's.

/// A position at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fix {
    pub(crate) time_s: f64,
    /// Easting and northing, m.
    pub(crate) place_m: [f64; 2],
}

/// A fix is off by more than so many standard deviations of all: of 36,000 that are normal not one is.
pub(super) const OFF_STD: f64 = 6.0;
/// And by more than this, m: what changing turns and the last digits of a coarse receiver (1e-5 degrees) do.
pub(super) const OFF_M: f64 = 2.0;
