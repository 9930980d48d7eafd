//! Names that people give to columns.

use towmag_recording::Column;

use crate::units;

/// A name in one spelling: lower case, letters and digits parted by single underscores.
pub(super) fn normalised(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    let mut before = ' ';
    for c in name.trim().chars() {
        let is_new_word = c.is_uppercase() && before.is_lowercase();
        if (!c.is_alphanumeric() || is_new_word) && !out.ends_with('_') && !out.is_empty() {
            out.push('_');
        }
        if c.is_alphanumeric() {
            out.extend(c.to_lowercase());
        }
        before = c;
    }
    out.trim_end_matches('_').to_string()
}

/// A normalised name without the unit at its end.
pub(super) fn stem(name: &str) -> &str {
    units::suffix(name).and_then(|_| name.rsplit_once('_')).map_or(name, |(stem, _)| stem)
}

/// Normalised names of the columns but for time and magnetic sensors, the likelier first. This project's own names stand for
/// themselves and are not repeated.
const ALIASES: &[(Column, &[&str])] = &[
    (Column::ScalarValid, &["mag_valid", "magvalid", "scalar_ok", "mag_ok", "valid", "mag_1_valid", "mag1_valid"]),
    (Column::ScalarSignal, &["signal", "signal_strength", "mag_signal", "sig", "mag_sig", "mag1_signal", "amplitude"]),
    (
        Column::Depth,
        &[
            "depth",
            "fish_depth",
            "sensor_depth",
            "body_depth",
            "towfish_depth",
            "depth_body",
            "pressure_depth",
            "tiefe",
            "mag_depth",
        ],
    ),
    (
        Column::Temperature,
        &["temperature", "temp", "flux_temp", "flux_temperature", "fluxgate_temperature", "temperatur"],
    ),
    (Column::Roll, &["roll", "ins_roll", "imu_roll", "roll_angle", "rollwinkel"]),
    (Column::Pitch, &["pitch", "ins_pitch", "imu_pitch", "pitch_angle"]),
    (Column::Heading, &["heading", "hdg", "yaw", "ins_yaw", "azimuth", "true_heading", "head", "ins_heading", "kurs"]),
    (Column::Latitude, &["latitude", "lat", "gps_lat", "gps_latitude", "lat_wgs84", "lat_dd", "breite", "ins_lat"]),
    (
        Column::Longitude,
        &[
            "longitude",
            "lon",
            "long",
            "lng",
            "gps_lon",
            "gps_long",
            "gps_longitude",
            "lon_wgs84",
            "lon_dd",
            "laenge",
            "ins_lon",
        ],
    ),
    (
        Column::Line,
        &["line", "line_number", "line_no", "lineno", "line_name", "leg", "lineid", "line_id", "profile", "linie"],
    ),
    (
        Column::Altitude,
        &["altitude", "altimeter", "height_above_bottom", "alt_above_bottom", "hab", "radar_altimeter", "radar", "alt"],
    ),
    (Column::Base, &["base", "base_mag", "base_field", "basemag", "base_station"]),
    (Column::CableOut, &["cable_out", "cable", "cable_length", "cableout", "payout", "wire_out"]),
    (Column::Speed, &["speed", "sog", "speed_over_ground", "gps_speed", "ground_speed", "velocity", "speedoverground"]),
    (Column::BatteryVoltage, &["battery", "vbat", "battery_voltage", "vbatt"]),
];

/// How well a name stands for a column: 0 not at all, this project's own the best.
pub(super) fn fit(column: Column, name: &str) -> u32 {
    if name == column.name() {
        return 1000;
    }
    let name = normalised(name);
    if name == normalised(column.name()) {
        return 999;
    }
    let aliases = ALIASES.iter().find(|(of, _)| *of == column).map(|(_, aliases)| *aliases).unwrap_or_default();
    let at = aliases.iter().position(|alias| *alias == name || *alias == stem(&name));
    at.map_or(0, |at| 500 - at as u32)
}

/// The name of the load of a column of currents: of `cur_strb`, `strobe_current`, `current_strobe_A`.
pub(super) fn load(name: &str, is_in_amperes: bool) -> Option<String> {
    let name = normalised(name);
    let stem = stem(&name);
    let load = stem
        .strip_prefix("current_")
        .or(stem.strip_prefix("cur_"))
        .or(stem.strip_suffix("_current"))
        .or(stem.strip_suffix("_cur"))
        .or(is_in_amperes.then_some(stem))?;
    (!load.is_empty()).then(|| load.trim_end_matches("_a").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_spelling() {
        for (name, one) in [
            ("Mag Raw", "mag_raw"),
            ("magRaw", "mag_raw"),
            ("RAWMAG", "rawmag"),
            (" GPS-Latitude ", "gps_latitude"),
            ("scalar_nT", "scalar_n_t"),
            ("_x_", "x"),
        ] {
            assert_eq!(normalised(name), one, "{name}");
        }
    }

    #[test]
    fn aliases_and_their_units() {
        assert!(fit(Column::Depth, "depth_m") > fit(Column::Depth, "Depth"));
        assert!(fit(Column::Depth, "Fish Depth") > 0 && fit(Column::Depth, "fish_depth_ft") > 0);
        assert!(fit(Column::Heading, "HDG") > 0 && fit(Column::Heading, "heading_error") == 0);
        assert!(fit(Column::Latitude, "lat") > 0 && fit(Column::Longitude, "lat") == 0);
    }

    #[test]
    fn loads() {
        for (name, is_in_amperes, found) in [
            ("cur_strb", false, Some("strb")),
            ("current_pump_A", true, Some("pump")),
            ("Pump current", false, Some("pump")),
            ("pump", true, Some("pump")),
            ("pump", false, None),
            ("current", false, None),
        ] {
            assert_eq!(load(name, is_in_amperes).as_deref(), found, "{name}");
        }
    }
}
