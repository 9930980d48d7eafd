//! The 10 Hz of every recording, and what of it a step between two rows may miss.

/// Rows a second, and the time from one row to the next, s: an epoch of the core is a row.
pub use towmag::{EPOCH_S, RATE_HZ};

/// A step may be off by this much and still be one epoch, s: 0.05 to 0.15 s.
pub(super) const JITTER_S: f64 = 0.05;
/// Times are decimal fractions: 12.35 - 12.3 is a little less than 0.05 in `f64`, the more so with seconds since 1970.
pub const TIME_ROUNDING_S: f64 = 1e-6;
/// A longer step between two rows is a gap, s, give or take [`TIME_ROUNDING_S`].
pub const LONGEST_STEP_S: f64 = 0.15;
