//! The rows of a recording in a scenario: what is passed when, which are missing, and which columns are written.

use serde::Deserialize;

/// A dipole that the body passes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetSpec {
    /// Closest approach, s after the first row.
    pub at_s: f64,
    /// Peak, nT.
    #[serde(rename = "peak_nT")]
    pub peak_nt: f64,
    /// Width at half the peak, s.
    pub width_s: f64,
}

/// A ship that tows: its position is recorded, and how much cable is out.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ship {
    /// Cable between its antenna and the body, straight, m: column `cable_out_m`.
    pub cable_out_m: f64,
}

/// From when for how long.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Begin, s after the first row.
    pub begin_s: f64,
    /// Length, s.
    pub length_s: f64,
}

impl Interval {
    pub(super) fn contains(&self, time_s: f64) -> bool {
        // To half a row: a begin of 12.3 means the row that is written as 12.3.
        (self.begin_s - 0.05..self.begin_s + self.length_s - 0.05).contains(&time_s)
    }
}

/// Optional columns.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Columns {
    /// `roll_deg`, `pitch_deg`, `heading_deg`.
    pub attitude: bool,
    /// `depth_m`, of a tow.
    pub depth: bool,
    /// `line`: `leg1`, `turn1`, `leg2` and so on.
    pub line: bool,
    /// `latitude_deg`, `longitude_deg`: of the body, or of the ship if there is one.
    pub position: bool,
    /// `altitude_m`: height of the body above the bottom.
    pub altitude: bool,
    /// `speed_m_per_s`.
    pub speed: bool,
    /// `utc_s`.
    pub utc: bool,
}
