//! Units of the fields of MagNav data sets, which the files themselves do not tell.
//!
//! Names and units: the read-me files of the data sets and `get_XYZ.jl` of MagNav.jl. Files of the data sets have `lat` and
//! `lon` in degrees, `ins_lat` and `ins_lon` in radians; those that MagNav.jl writes have all of them in radians. So a unit
//! is told only where the values agree with it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::source::SourceColumn;

/// What total field there is on Earth, with room for what a vehicle adds, nT.
const TOTAL_FIELD_NT: std::ops::RangeInclusive<f64> = 1_000.0..=200_000.0;

/// The same columns with the units that names and values tell together; a unit that a file gave itself stays.
pub(in crate::formats) fn with_known_units(columns: Vec<SourceColumn>) -> Vec<SourceColumn> {
    let units: Vec<Option<&str>> = columns.iter().map(|column| unit(column, &columns)).collect();
    let told = |(column, unit): (SourceColumn, Option<&str>)| match unit {
        Some(unit) if column.unit.is_none() => column.in_unit(unit),
        _ => column,
    };
    columns.into_iter().zip(units).map(told).collect()
}

fn unit(column: &SourceColumn, all: &[SourceColumn]) -> Option<&'static str> {
    let name = column.name.as_str();
    match name {
        "tt" => Some("s"),
        "lat" | "lon" => angle(&[("lat", FRAC_PI_2), ("lon", PI)], all),
        "ins_lat" | "ins_lon" => angle(&[("ins_lat", FRAC_PI_2), ("ins_lon", PI)], all),
        "roll" | "pitch" | "yaw" => angle(&[("roll", TAU), ("pitch", TAU), ("yaw", TAU)], all),
        "ins_roll" | "ins_pitch" | "ins_yaw" => angle(&[("ins_roll", TAU), ("ins_pitch", TAU), ("ins_yaw", TAU)], all),
        "utm_x" | "utm_y" | "utm_z" | "msl" | "radar" | "topo" | "dem" | "drape" | "ins_alt" => Some("m"),
        "diurnal" | "igrf" => (largest(column)? <= *TOTAL_FIELD_NT.end()).then_some("nT"),
        _ if name.starts_with("mag_") || name == "ogs_mag" => magnetometer(column),
        _ if name.starts_with("flux_") => fluxgate(name, all),
        _ if name.starts_with("cur_") => Some("A"),
        _ if name.starts_with("vol_") => Some("V"),
        _ => None,
    }
}

/// Radians where all of these angles are there and none is beyond its limit, degrees where one is.
fn angle(limits: &[(&str, f64)], all: &[SourceColumn]) -> Option<&'static str> {
    let size = |name: &str| all.iter().find(|column| column.name == name).and_then(largest);
    if limits.iter().any(|(name, limit)| size(name).is_some_and(|size| size > *limit)) {
        return Some("deg");
    }
    limits.iter().all(|(name, _)| size(name).is_some()).then_some("rad")
}

/// Readings of the total field; what was subtracted from it (`mag_1_igrf`) may be small.
fn magnetometer(column: &SourceColumn) -> Option<&'static str> {
    let is_reading = column.name.ends_with("_uc") || column.name.ends_with("_c") || column.name.ends_with("_lag");
    let size =
        if is_reading { median(column.as_numbers()?.iter().map(|value| value.abs()))? } else { largest(column)? };
    let is_likely = if is_reading { TOTAL_FIELD_NT.contains(&size) } else { size <= *TOTAL_FIELD_NT.end() };
    is_likely.then_some("nT")
}

/// A component may be anything; the vector that it belongs to tells.
fn fluxgate(name: &str, all: &[SourceColumn]) -> Option<&'static str> {
    let (sensor, _) = name.rsplit_once('_')?;
    let axis = |axis: &str| {
        let full = format!("{sensor}_{axis}");
        all.iter().find(|column| column.name == full).and_then(SourceColumn::as_numbers)
    };
    let size = match (axis("x"), axis("y"), axis("z")) {
        (Some(x), Some(y), Some(z)) => median(x.iter().zip(y).zip(z).map(|((x, y), z)| x.hypot(*y).hypot(*z)))?,
        _ => median(axis("t")?.iter().copied())?,
    };
    TOTAL_FIELD_NT.contains(&size).then_some("nT")
}

fn largest(column: &SourceColumn) -> Option<f64> {
    let sizes = column.as_numbers()?.iter().filter(|value| value.is_finite()).map(|value| value.abs());
    sizes.max_by(f64::total_cmp)
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(columns: &[(&str, &[f64])]) -> Vec<Option<String>> {
        let columns = columns.iter().map(|(name, values)| SourceColumn::numbers(*name, values.to_vec())).collect();
        with_known_units(columns).into_iter().map(|column| column.unit).collect()
    }

    #[test]
    fn the_same_name_is_in_degrees_or_radians_as_its_values_are() {
        let degrees = units(&[("lat", &[45.2]), ("lon", &[-75.6]), ("ins_lat", &[0.79]), ("ins_lon", &[-1.32])]);
        assert_eq!(degrees, ["deg", "deg", "rad", "rad"].map(|unit| Some(unit.into())));
        assert_eq!(units(&[("lat", &[0.79]), ("lon", &[-1.32])]), [Some("rad".into()), Some("rad".into())]);
        assert_eq!(units(&[("lat", &[0.79])]), [None], "without a longitude it may be either");
        assert_eq!(units(&[("roll", &[1.0]), ("pitch", &[2.0]), ("yaw", &[350.0])])[0], Some("deg".into()));
    }

    #[test]
    fn nanotesla_are_told_only_of_what_can_be_the_earths_field() {
        let flux = |scale: f64| [20_000.0 * scale, 0.0, 45_000.0 * scale];
        let [x, y, z] = flux(1.0);
        assert_eq!(units(&[("flux_a_x", &[x]), ("flux_a_y", &[y]), ("flux_a_z", &[z])])[1], Some("nT".into()));
        let [x, y, z] = flux(1e-3);
        assert_eq!(units(&[("flux_a_x", &[x]), ("flux_a_y", &[y]), ("flux_a_z", &[z])])[1], None);
        assert_eq!(units(&[("mag_1_uc", &[f64::NAN, 52_000.0]), ("mag_2_uc", &[52.0])]), [Some("nT".into()), None]);
        assert_eq!(units(&[("cur_strb", &[1.0]), ("vol_bat", &[28.0]), ("other", &[1.0])])[2], None);
    }
}
