//! The Earth's field by the world magnetic model, which knows the years 2025 to 2029.

use world_magnetic_model::GeomagneticField;
use world_magnetic_model::time::Date;
use world_magnetic_model::uom::si::angle::degree;
use world_magnetic_model::uom::si::f32::{Angle, Length};
use world_magnetic_model::uom::si::length::meter;
use world_magnetic_model::uom::si::magnetic_flux_density::nanotesla;

/// A reading may be this share off the model: the body's own field, rock, and years outside of the model's five.
pub const TOLERANCE: f64 = 0.08;

/// The field to the north, east and down at a place and a height above the ellipsoid, nT.
///
/// # Errors
///
/// What is wrong with place or day.
pub fn north_east_down_nt(
    [latitude_deg, longitude_deg]: [f64; 2],
    height_m: f64,
    day: Date,
) -> Result<[f64; 3], String> {
    let angle = |deg: f64| Angle::new::<degree>(deg as f32);
    let height = Length::new::<meter>(height_m as f32);
    let field = GeomagneticField::new(height, angle(latitude_deg), angle(longitude_deg), day);
    let field = field.map_err(|error| error.to_string())?;
    Ok([field.x(), field.y(), field.z()].map(|b| f64::from(b.get::<nanotesla>())))
}

/// Its magnitude, nT.
pub fn total_nt(north_east_down_nt: [f64; 3]) -> f64 {
    north_east_down_nt.iter().map(|nt| nt * nt).sum::<f64>().sqrt()
}
