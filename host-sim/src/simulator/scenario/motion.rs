//! The motion of the body in a scenario.

use serde::Deserialize;

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
        /// Speed over the ground of a body that is carried, m/s; without, it stays where it is.
        #[serde(default)]
        speed_m_per_s: Option<f64>,
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
        /// Speed of the tow, m/s; needed where a place is asked for.
        #[serde(default)]
        speed_m_per_s: Option<f64>,
    },
    /// Towed on a sea: waves of a standard spectrum drive heave, pitch, roll and yaw.
    SeaTow {
        /// Legs and turns.
        tow: Tow,
        /// Shape of the spectrum.
        spectrum: WaveSpectrum,
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

impl Motion {
    /// Speed of the body along its course, m/s, where it is said.
    pub fn speed_m_per_s(&self) -> Option<f64> {
        match self {
            Self::LandCalibration { speed_m_per_s, .. } | Self::LakeTow { speed_m_per_s, .. } => *speed_m_per_s,
            Self::SeaTow { speed_m_per_s, .. } => Some(*speed_m_per_s),
        }
    }
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
    /// Every other turn is to port: lines side by side.
    #[serde(default)]
    pub alternates: bool,
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
pub enum WaveSpectrum {
    /// Fully developed: Pierson and Moskowitz 1964.
    PiersonMoskowitz,
    /// Growing, peak enhanced 3.3 times: Hasselmann et al. 1973.
    Jonswap,
}
