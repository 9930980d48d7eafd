//! The body in a scenario: what it adds to the field, its sensors and its loads.

use serde::Deserialize;
use towmag::model::TERMS;

/// The 18 terms: given, or drawn and scaled.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterferenceSource {
    /// In the units and the order of eq. (4).
    pub coefficients: Option<[f64; TERMS]>,
    /// Standard deviation that the drawn or given terms are scaled to, band-passed 0.1 to 0.9 Hz, nT.
    #[serde(rename = "uncompensated_std_nT")]
    pub uncompensated_std_nt: Option<f64>,
}

/// Noise and resolution of a sensor.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Noise of the reading, of each axis, nT rms.
    #[serde(rename = "noise_rms_nT")]
    pub noise_rms_nt: f64,
    /// Its colour.
    #[serde(default)]
    pub noise_colour: Colour,
    /// Of AR(1) noise: correlation of one row with the next, 0 to 0.999.
    #[serde(default)]
    pub noise_correlation: f64,
    /// What the reading is rounded to, nT.
    #[serde(rename = "resolution_nT")]
    pub resolution_nt: f64,
    /// Decimals that it is written with, 0 to 9, for an export that pads; those that the resolution needs where not said.
    #[serde(default)]
    pub decimals: Option<usize>,
}

/// A second scalar sensor ahead of the first or behind it, where the body's own field is another.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondScalar {
    /// How far ahead of the first it is, m; negative behind it.
    pub ahead_m: f64,
    /// What the body adds to the field there.
    pub interference: InterferenceSource,
    /// Noise and resolution.
    pub sensor: Sensor,
}

/// Colours of noise.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Colour {
    /// The same power at every frequency.
    #[default]
    White,
    /// Power that falls with 1 / frequency, from 0.003 Hz on.
    Pink,
    /// First-order autoregressive.
    Ar1,
}

/// Where the scalar sensor says that it reads nothing: within an angle of an axis.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlaggedZone {
    /// From forward to starboard, degrees.
    pub axis_azimuth_deg: f64,
    /// Positive down, degrees.
    pub axis_elevation_deg: f64,
    /// Degrees, in either sense of the axis.
    pub half_angle_deg: f64,
}

/// Temperature that goes exponentially from one value to another.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Temperature {
    /// At the first row, degC.
    #[serde(rename = "first_degC")]
    pub first_deg_c: f64,
    /// In the end, degC.
    #[serde(rename = "final_degC")]
    pub final_deg_c: f64,
    /// Time constant, s.
    pub time_constant_s: f64,
}

/// A load that switches, for a column `current_<name>_A`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Current {
    /// Name of the load.
    pub name: String,
    /// Current while on, A.
    #[serde(rename = "on_A")]
    pub on_a: f64,
    /// Current while off, A.
    #[serde(default, rename = "off_A")]
    pub off_a: f64,
    /// Length of a cycle, s.
    pub period_s: f64,
    /// Share of the cycle that it is on, from its begin.
    pub duty: f64,
    /// Of the first row, cycles.
    #[serde(default)]
    pub phase: f64,
}
