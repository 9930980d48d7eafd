//! Iron in a scenario: a magnetic dipole at a place.

use serde::Deserialize;

use super::range::within;

/// A dipole: its moment, and where it lies, by the track (`at_s`, `offset_m`, `below_m`) or by its place.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DipoleSpec {
    /// Its moment, A m^2.
    #[serde(rename = "moment_Am2")]
    pub moment_am2: Moment,
    /// Direction of a moment that is given by its size: below the horizon, degrees.
    pub inclination_deg: Option<f64>,
    /// The same, east of north, degrees.
    pub declination_deg: Option<f64>,
    /// When the body has it abeam, s after the first row.
    pub at_s: Option<f64>,
    /// How far to starboard of the track it then is, m.
    pub offset_m: Option<f64>,
    /// How far below the body it then is, m.
    pub below_m: Option<f64>,
    /// WGS 84, north positive.
    pub latitude_deg: Option<f64>,
    /// WGS 84, east positive.
    pub longitude_deg: Option<f64>,
    /// Below the surface, m.
    pub depth_m: Option<f64>,
}

/// A moment by its components or by its size.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Moment {
    /// North, east, down, A m^2.
    Components([f64; 3]),
    /// Size, A m^2.
    Size(f64),
}

/// Where a dipole lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lies {
    /// Abeam at a time, s: to starboard and below, m.
    ByTrack { at_s: f64, offset_m: f64, below_m: f64 },
    /// At a latitude and longitude, degrees, and a depth, m.
    ByPlace { latitude_deg: f64, longitude_deg: f64, depth_m: f64 },
}

impl DipoleSpec {
    /// North, east, down, A m^2.
    pub(super) fn moment(&self) -> [f64; 3] {
        match self.moment_am2 {
            Moment::Components(components) => components,
            Moment::Size(size) => {
                let angle = |deg: Option<f64>| libm::sincos(deg.unwrap_or(0.0).to_radians());
                let ((sin_i, cos_i), (sin_d, cos_d)) = (angle(self.inclination_deg), angle(self.declination_deg));
                [size * cos_i * cos_d, size * cos_i * sin_d, size * sin_i]
            }
        }
    }

    /// Where it lies, if that is said in one of the two ways.
    pub(super) fn lies(&self) -> Option<Lies> {
        let by_track = (self.at_s, self.offset_m, self.below_m);
        let by_place = (self.latitude_deg, self.longitude_deg, self.depth_m);
        match (by_track, by_place) {
            ((Some(at_s), Some(offset_m), Some(below_m)), (None, None, None)) => {
                Some(Lies::ByTrack { at_s, offset_m, below_m })
            }
            ((None, None, None), (Some(latitude_deg), Some(longitude_deg), Some(depth_m))) => {
                Some(Lies::ByPlace { latitude_deg, longitude_deg, depth_m })
            }
            _ => None,
        }
    }

    pub(super) fn check(&self, has_place: bool) -> Result<(), String> {
        self.moment().into_iter().try_for_each(|part| within("dipole.moment_Am2", part, -1e9..=1e9))?;
        let is_size = matches!(self.moment_am2, Moment::Size(_));
        if [self.inclination_deg, self.declination_deg].iter().any(|angle| angle.is_some() != is_size) {
            return Err("dipole: give moment_Am2 as three numbers (north, east, down), or as one with \
                        inclination_deg and declination_deg"
                .into());
        }
        within("dipole.inclination_deg", self.inclination_deg.unwrap_or(0.0), -90.0..=90.0)?;
        within("dipole.declination_deg", self.declination_deg.unwrap_or(0.0), -360.0..=360.0)?;
        match self.lies() {
            Some(Lies::ByTrack { at_s, offset_m, below_m }) => {
                within("dipole.at_s", at_s, 0.0..=1e5)?;
                within("dipole.offset_m", offset_m, -1e5..=1e5)?;
                within("dipole.below_m", below_m, -1e5..=1e5)?;
                // Nearer than the sensor is long, a dipole is no model of anything.
                within("dipole: distance, m", libm::hypot(offset_m, below_m), 0.3..=2e5)
            }
            Some(Lies::ByPlace { latitude_deg, longitude_deg, depth_m }) if has_place => {
                within("dipole.latitude_deg", latitude_deg, -89.0..=89.0)?;
                within("dipole.longitude_deg", longitude_deg, -180.0..=180.0)?;
                within("dipole.depth_m", depth_m, -100.0..=12_000.0)
            }
            Some(_) => Err("dipole.latitude_deg: needs a [field] with a place".into()),
            None => Err("dipole: give at_s, offset_m and below_m, or latitude_deg, longitude_deg and depth_m".into()),
        }
    }
}
