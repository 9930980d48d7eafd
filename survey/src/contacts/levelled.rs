//! What contacts are looked for in, and how.

use crate::level::Coefficients;
use crate::navigation::Track;

/// Rows a second of everything that is surveyed.
pub(crate) const RATE_HZ: f64 = 10.0;

/// What contacts are looked for in.
#[derive(Clone, Copy, Debug)]
pub struct Levelled<'a> {
    /// Time, s.
    pub time_s: &'a [f64],
    /// Rows that count.
    pub is_valid: &'a [bool],
    /// Compensated total field at its level, nT, targets untouched; NaN where a row does not count.
    pub field_nt: &'a [f64],
    /// By how much the noise of each row is known to be louder than usual, as a variance, nT^2, independent from row to row.
    pub variance_nt2: Option<&'a [f64]>,
    /// The 18 terms of one field in nT a unit coefficient, one row each: what compensation may have taken along, or left.
    pub terms: &'a [[f64; 18]],
    /// Unit vector of the Earth's field in body axes (forward, starboard, down).
    pub direction: &'a [[f64; 3]],
    /// The track, if positions or at least the speed are known. Without it distances are in seconds only.
    pub track: Option<&'a Track>,
    /// Height above the bottom, m, where it is known.
    pub altitude_m: Option<&'a [f64]>,
    /// Depth below the surface, m, where it is known.
    pub depth_m: Option<&'a [f64]>,
}

/// What tells the way. Positions wander by tenths of a metre and more in the time of a pass, which no smoother tells from a body that moves
/// so; where it heads the fluxgate sees at every row, and its speed is steady.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WayBy {
    /// Positions, if there are some, else speeds, else the time.
    #[default]
    Positions,
    /// The fluxgate's heading, at the speed that positions have over a minute.
    Heading,
}

/// Half the distance: the anomaly is half as wide.
const ALIKE: f64 = 0.5;

/// How contacts are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// False contacts an hour that the threshold stands for.
    pub false_alarms_per_hour: f64,
    /// Shortest and longest distance over speed that is looked for, s.
    pub distances_s: [f64; 2],
    /// Those of the level that is searched. Where they stay as they are they are fitted anew beside the contacts, and what is loud
    /// for a while is a contact that is not fitted well; where they move it is what compensation leaves.
    pub coefficients: Coefficients,
    /// Where something was no dipole, what is nearer than this share of its distance, 0 to 1, is another object and is looked at: iron
    /// that lies on slow rock. With 0 nothing there is looked at again.
    pub alike: f64,
    /// What tells the way on which an anomaly is that of a dipole.
    pub way_by: WayBy,
}

impl Default for Options {
    /// One false contact in two hours; 2 m at 4 m/s to 15 m at 1 m/s.
    fn default() -> Self {
        Self {
            false_alarms_per_hour: 0.5,
            distances_s: [0.4, 15.0],
            coefficients: Coefficients::Moving,
            alike: ALIKE,
            way_by: WayBy::Positions,
        }
    }
}
