//! The 10 Hz of every recording, and what of it a step between two rows may miss.

/// Rows a second.
pub const RATE_HZ: f64 = 10.0;
/// From one row to the next, s.
pub const EPOCH_S: f64 = 0.1;
/// A step may be off by this much and still be one epoch, s: 0.05 to 0.15 s.
pub(super) const JITTER_S: f64 = 0.05;
/// Times are decimal fractions: 12.35 - 12.3 is a little less than 0.05 in `f64`, the more so with seconds since 1970.
pub const TIME_ROUNDING_S: f64 = 1e-6;
/// A longer step between two rows is a gap, s, give or take [`TIME_ROUNDING_S`].
pub const LONGEST_STEP_S: f64 = 0.15;
