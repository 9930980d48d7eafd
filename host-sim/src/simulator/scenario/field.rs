//! The Earth's field in a scenario.

use serde::Deserialize;

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
    /// Time of day of the first row, UTC, `hh:mm:ss`; midnight where not said.
    pub time: Option<String>,
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

/// What lies below.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bottom {
    /// Depth of the bottom below the surface, m.
    pub depth_m: f64,
}
