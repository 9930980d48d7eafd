//! What a survey needs of a recording.

use std::ops::Range;
use std::sync::Arc;

/// The columns of one recording at 10 Hz, all of the same length. Of optional ones: `None` where the recording does not
/// have it, NaN where a value is missing.
#[derive(Clone, Debug, Default)]
pub struct Tow {
    /// How the user named it.
    pub name: String,
    /// Time, s, of any origin; strictly increasing over the usable rows.
    pub time_s: Vec<f64>,
    /// Rows with every required value, of a scalar sensor that calls itself valid.
    pub is_usable: Vec<bool>,
    /// Total field as read, nT; less what is known to be wrong of a reading.
    pub scalar_nt: Vec<f64>,
    /// By how much the noise of each reading is known to be louder than usual, as a variance, nT^2, independent from row to row.
    pub scalar_variance_nt2: Option<Vec<f64>>,
    /// Fluxgate in body axes (forward, starboard, down), nT.
    pub flux_nt: Vec<[f64; 3]>,
    /// Survey line of each row; empty text where there is none.
    pub line: Option<Vec<Arc<str>>>,
    /// Second scalar sensor, nT; NaN also where it calls itself invalid.
    pub scalar2_nt: Option<Vec<f64>>,
    /// Total field at the base station, nT.
    pub base_nt: Option<Vec<f64>>,
    /// Depth of the body below the surface, m.
    pub depth_m: Option<Vec<f64>>,
    /// Height of the body above the bottom, m.
    pub altitude_m: Option<Vec<f64>>,
    /// From true north by east, degrees, of an independent sensor.
    pub heading_deg: Option<Vec<f64>>,
    /// WGS 84, degrees: the body's, or the ship's where the user says so.
    pub latitude_deg: Option<Vec<f64>>,
    /// WGS 84, degrees.
    pub longitude_deg: Option<Vec<f64>>,
    /// Seconds since 1970-01-01 UTC.
    pub utc_s: Option<Vec<f64>>,
    /// Cable paid out, m.
    pub cable_out_m: Option<Vec<f64>>,
    /// Speed of the tow through or over ground, m/s.
    pub speed_m_per_s: Option<Vec<f64>>,
}

/// A longer step than this is a gap, s: see the recording format.
const LONGEST_STEP_S: f64 = 0.15;

impl Tow {
    /// How many rows.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Stretches of usable rows without a gap in time, as ranges of rows.
    pub fn stretches(&self) -> Vec<Range<usize>> {
        let mut stretches: Vec<Range<usize>> = Vec::new();
        for row in (0..self.len()).filter(|&row| self.is_usable[row]) {
            match stretches.last_mut() {
                Some(last) if last.end == row && self.time_s[row] - self.time_s[row - 1] <= LONGEST_STEP_S => {
                    last.end = row + 1;
                }
                _ => stretches.push(row..row + 1),
            }
        }
        stretches
    }
}
