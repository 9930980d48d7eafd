//! A scenario: the TOML file that `host-sim simulate` makes a recording from. Every key is in `docs/scenarios.md`.

mod check;
mod earth;
mod noise;
mod path;
mod sensed;
mod simulation;
mod table;
mod waves;

#[cfg(test)]
mod tests;

pub use sensed::Lost;
pub(crate) use simulation::band_passed_std_nt;
pub use simulation::{Recorded, Simulation};

use std::path::Path;

use serde::Deserialize;
use towmag::model::TERMS;

use crate::error::HostError;

/// A whole scenario.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What it is, for the reader.
    #[serde(default)]
    pub title: String,
    /// Seed of everything random, where the command line gives none.
    #[serde(default = "one")]
    pub seed: u64,
    /// Length of the recording, s.
    pub duration_s: f64,
    /// Time of the first row on the recording's own axis, s.
    #[serde(default)]
    pub first_time_s: f64,
    /// The Earth's field.
    pub field: Field,
    /// What changes it slowly.
    #[serde(default)]
    pub background: Background,
    /// How the body moves.
    pub motion: Motion,
    /// What the body adds to the field.
    pub interference: InterferenceSource,
    /// The scalar sensor.
    pub scalar: Sensor,
    /// The fluxgate.
    pub fluxgate: Sensor,
    /// Where the scalar sensor flags its readings as invalid.
    pub dead_zone: Option<FlaggedZone>,
    /// Temperature at the fluxgate.
    pub temperature: Option<Temperature>,
    /// Loads whose current is recorded.
    #[serde(default, rename = "current")]
    pub currents: Vec<Current>,
    /// What a survey is for.
    #[serde(default, rename = "target")]
    pub targets: Vec<TargetSpec>,
    /// Times whose rows are missing.
    #[serde(default, rename = "gap")]
    pub gaps: Vec<Interval>,
    /// Times in which the scalar sensor flags its readings as invalid.
    #[serde(default, rename = "dropout")]
    pub dropouts: Vec<Interval>,
    /// Which optional columns are written.
    #[serde(default)]
    pub columns: Columns,
}

/// The Earth's field: from the World Magnetic Model at a place and date, or given.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// WGS 84, north positive.
    pub latitude_deg: Option<f64>,
    /// WGS 84, east positive.
    pub longitude_deg: Option<f64>,
    /// Above the ellipsoid, m.
    #[serde(default)]
    pub height_m: f64,
    /// Day, `YYYY-MM-DD`.
    pub date: Option<String>,
    /// Magnitude, nT; with a place: as measured there, for the model knows no local rock.
    #[serde(rename = "strength_nT")]
    pub strength_nt: Option<f64>,
    /// Below the horizon, degrees.
    pub inclination_deg: Option<f64>,
    /// East of north, degrees.
    pub declination_deg: Option<f64>,
}

/// Slow changes of the field, below 0.02 Hz.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Background {
    /// Geology along the track, nT rms.
    #[serde(rename = "geology_rms_nT")]
    pub geology_rms_nt: f64,
    /// Its shortest period, s.
    pub geology_shortest_period_s: f64,
    /// Diurnal change, nT per hour.
    #[serde(rename = "diurnal_nT_per_h")]
    pub diurnal_nt_per_h: f64,
}

impl Default for Background {
    fn default() -> Self {
        Self { geology_rms_nt: 0.0, geology_shortest_period_s: 60.0, diurnal_nt_per_h: 0.0 }
    }
}

/// How the body moves.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Motion {
    /// Rocked by hand or gimbal on land: roll, pitch and yaw one after the other on each heading.
    LandCalibration {
        /// How many headings a round has: 4 or 8.
        headings: u32,
        /// Heading of the first, degrees.
        #[serde(default)]
        first_heading_deg: f64,
        /// Time on a heading, s.
        leg_s: f64,
        /// Time of a turn, s.
        turn_s: f64,
        /// Rocking about each axis, degrees rms at its height.
        roll_rms_deg: f64,
        /// See `roll_rms_deg`.
        pitch_rms_deg: f64,
        /// See `roll_rms_deg`.
        yaw_rms_deg: f64,
        /// Period of the rocking, s.
        rocking_period_s: f64,
        /// Shake of 1 Hz about all axes at the end of each heading, degrees rms.
        #[serde(default)]
        shake_rms_deg: f64,
        /// How long it is shaken, s.
        #[serde(default)]
        shake_s: f64,
    },
    /// Towed on calm water: the body swings on its cable.
    LakeTow {
        /// Legs and turns.
        tow: Tow,
        /// Longest period of the swing, s.
        longest_period_s: f64,
        /// Shortest period of the swing, s.
        shortest_period_s: f64,
        /// Slow change of depth, m rms.
        #[serde(default)]
        depth_rms_m: f64,
    },
    /// Towed on a sea: waves of a standard spectrum drive heave, pitch, roll and yaw.
    SeaTow {
        /// Legs and turns.
        tow: Tow,
        /// Shape of the spectrum.
        spectrum: Spectrum,
        /// Significant height of the waves, m.
        significant_height_m: f64,
        /// Period of its peak, s.
        peak_period_s: f64,
        /// Where the waves come from, degrees from north by east.
        wave_from_deg: f64,
        /// Speed of the tow, m/s.
        speed_m_per_s: f64,
        /// Heave of the body for a metre of the sea's surface, m/m.
        heave_per_wave: f64,
    },
}

/// Legs, turns, and how much the body turns about its axes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tow {
    /// Heading of the first leg, degrees.
    pub first_heading_deg: f64,
    /// Time on a leg, s.
    pub leg_s: f64,
    /// Time of a turn, s.
    pub turn_s: f64,
    /// Angle of a turn, to starboard, degrees.
    pub turn_deg: f64,
    /// Roll, degrees rms.
    pub roll_rms_deg: f64,
    /// Pitch, degrees rms.
    pub pitch_rms_deg: f64,
    /// Yaw, degrees rms.
    pub yaw_rms_deg: f64,
    /// Mean depth, m.
    pub depth_m: f64,
}

/// Spectra of a sea.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Spectrum {
    /// Fully developed: Pierson and Moskowitz 1964.
    PiersonMoskowitz,
    /// Growing, peak enhanced 3.3 times: Hasselmann et al. 1973.
    Jonswap,
}

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
    fn contains(&self, time_s: f64) -> bool {
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
}

fn one() -> u64 {
    1
}

impl Scenario {
    /// Read and check a file.
    pub fn read(path: &Path) -> Result<Self, HostError> {
        let file = path.display();
        let text = std::fs::read_to_string(path)
            .map_err(|error| HostError::Usage(format!("{file}: cannot be read: {error}")))?;
        Self::parse(&text).map_err(|what| HostError::Usage(format!("{file}: {what}")))
    }

    /// From TOML. The error is one line: where, what, what to do.
    pub fn parse(text: &str) -> Result<Self, String> {
        let scenario: Self = toml::from_str(text).map_err(|error| one_line(text, &error))?;
        scenario.check()?;
        Ok(scenario)
    }
}

fn one_line(text: &str, error: &toml::de::Error) -> String {
    let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
    format!("line {line}: {}", error.message().replace('\n', " "))
}
