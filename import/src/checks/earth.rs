//! Against the world magnetic model, where position and date are known.

use towmag_recording::Column;
use world_magnetic_model::time::Date;

use crate::draft::Draft;
use crate::earth_model::{TOLERANCE, north_east_down_nt, total_nt};
use crate::field::magnitudes;
use crate::finding::Finding;
use crate::source::FindingKind;
use crate::statistics::median;

/// The Earth's field at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Earth {
    /// nT
    pub(super) total_nt: f64,
    /// nT, positive down.
    pub(super) down_nt: f64,
}

/// The model's field at the middle of the track; of years outside of the model the nearest one within it.
pub(super) fn at_the_track(draft: &Draft) -> Option<Earth> {
    let place = |column| median(draft.numbers(column)?.to_vec());
    let (latitude, longitude) = (place(Column::Latitude)?, place(Column::Longitude)?);
    if !(-90.0..=90.0).contains(&latitude) || (latitude == 0.0 && longitude == 0.0) {
        return None;
    }
    let utc_s = draft.is_utc.then(|| draft.time_s.first().copied()).flatten();
    let years = utc_s.map_or(2027.0, |utc_s| 1970.0 + utc_s / (365.25 * 86_400.0)).clamp(2025.0, 2029.9);
    let date = Date::from_ordinal_date(years as i32, 1 + (years.fract() * 364.0) as u16).ok()?;
    let longitude = if longitude > 180.0 { longitude - 360.0 } else { longitude };
    let field_nt = north_east_down_nt([latitude, longitude], 0.0, date).ok()?;
    Some(Earth { total_nt: total_nt(field_nt), down_nt: field_nt[2] })
}

/// Whether the scalar, or else the fluxgate's magnitude, is the Earth's at this place.
pub(super) fn check(draft: &Draft) -> Option<Finding> {
    let earth = at_the_track(draft)?;
    let (sensor, reading) = match draft.numbers(Column::Scalar) {
        Some(scalar) => ("scalar", median(scalar.to_vec())?),
        None => ("fluxgate", median(magnitudes(draft.flux()?))?),
    };
    let off = reading / earth.total_nt - 1.0;
    let text = format!(
        "the {sensor} reads {reading:.0} nT where the world magnetic model has {:.0} nT: another unit, another place, or another column",
        earth.total_nt
    );
    let option = if sensor == "scalar" { "--scalar NAME" } else { "--flux NAME" };
    (off.abs() > TOLERANCE).then(|| Finding::warning(FindingKind::Units, text).with(option))
}
