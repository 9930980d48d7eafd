//! Dipole targets along the track: a matched subspace detector with the measured noise, and fits of what it finds.

use crate::navigation::Track;

/// What contacts are looked for in.
#[derive(Clone, Copy, Debug)]
pub struct Levelled<'a> {
    /// Time, s.
    pub time_s: &'a [f64],
    /// Rows that count.
    pub is_valid: &'a [bool],
    /// Compensated total field at its level, nT, targets untouched; NaN where a row does not count.
    pub field_nt: &'a [f64],
    /// The 18 terms in nT a unit coefficient, one row each: what compensation may have taken along, or left.
    pub terms: &'a [[f64; 18]],
    /// Unit vector of the Earth's field in body axes (forward, starboard, down).
    pub direction: &'a [[f64; 3]],
    /// The track, if positions or at least the speed are known. Without it distances are in seconds only.
    pub track: Option<&'a Track>,
    /// Height above the bottom, m, where it is known.
    pub altitude_m: Option<&'a [f64]>,
}
