//! What a trial needs at least and takes at most.

/// Shortest recording that is made, minutes.
pub(crate) const LEAST_MINUTES: f64 = 2.0;
/// Longest, minutes.
pub(crate) const MOST_MINUTES: f64 = 120.0;
/// Valid rows that a real recording needs at least, s.
pub(crate) const LEAST_VALID_S: f64 = 60.0;
