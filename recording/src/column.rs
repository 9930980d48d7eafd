//! The columns that a recording may have: one line a column.

/// A column whose meaning is known. All others are passed through as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Seconds, strictly increasing; any origin.
    Time,
    /// Total field read by the scalar sensor.
    Scalar,
    /// Fluxgate, body axes: forward.
    FluxX,
    /// Fluxgate, body axes: starboard.
    FluxY,
    /// Fluxgate, body axes: down.
    FluxZ,
    /// The scalar sensor's own validity flag.
    ScalarValid,
    /// The scalar sensor's signal strength, as it reports it.
    ScalarSignal,
    /// Depth of the body below the surface, positive down.
    Depth,
    /// Temperature at the fluxgate.
    Temperature,
    /// Starboard down.
    Roll,
    /// Nose up.
    Pitch,
    /// From true north by east.
    Heading,
    /// WGS 84.
    Latitude,
    /// WGS 84.
    Longitude,
    /// Survey line or leg.
    Line,
    /// Seconds since 1970-01-01 UTC.
    Utc,
    /// Height of the body above the bottom.
    Altitude,
    /// Total field read by a second scalar sensor.
    Scalar2,
    /// The second scalar sensor's own validity flag.
    Scalar2Valid,
    /// Total field at the base station at that time.
    Base,
    /// Length of cable paid out.
    CableOut,
    /// Speed of the tow.
    Speed,
    /// Voltage of the body's battery.
    BatteryVoltage,
    /// Water at the body's leak contact.
    Leak,
}

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A finite number.
    Number,
    /// One or zero.
    Flag,
    /// Text.
    Label,
}

/// Name, unit and kind of a known column.
#[derive(Clone, Copy, Debug)]
pub struct ColumnSpec {
    /// Which one.
    pub column: Column,
    /// As in a header.
    pub name: &'static str,
    /// Unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// What its values are.
    pub kind: ColumnKind,
    /// Whether a recording must have it.
    pub is_required: bool,
}

/// Every known column, in the order of [`Column`]. Beside these there are the loads: see [`load_of`].
pub const COLUMNS: [ColumnSpec; Column::COUNT] = [
    required(Column::Time, "time_s", "s"),
    required(Column::Scalar, "scalar_nT", "nT"),
    required(Column::FluxX, "flux_x_nT", "nT"),
    required(Column::FluxY, "flux_y_nT", "nT"),
    required(Column::FluxZ, "flux_z_nT", "nT"),
    flag(Column::ScalarValid, "scalar_valid"),
    number(Column::ScalarSignal, "scalar_signal", ""),
    number(Column::Depth, "depth_m", "m"),
    number(Column::Temperature, "temperature_degC", "degC"),
    number(Column::Roll, "roll_deg", "deg"),
    number(Column::Pitch, "pitch_deg", "deg"),
    number(Column::Heading, "heading_deg", "deg"),
    number(Column::Latitude, "latitude_deg", "deg"),
    number(Column::Longitude, "longitude_deg", "deg"),
    label(Column::Line, "line"),
    number(Column::Utc, "utc_s", "s"),
    number(Column::Altitude, "altitude_m", "m"),
    number(Column::Scalar2, "scalar2_nT", "nT"),
    flag(Column::Scalar2Valid, "scalar2_valid"),
    number(Column::Base, "base_nT", "nT"),
    number(Column::CableOut, "cable_out_m", "m"),
    number(Column::Speed, "speed_m_per_s", "m/s"),
    number(Column::BatteryVoltage, "battery_V", "V"),
    flag(Column::Leak, "leak"),
];

/// Unit of the current of a load.
pub const LOAD_UNIT: &str = "A";

impl Column {
    /// How many known columns there are.
    pub const COUNT: usize = Self::Leak as usize + 1;

    /// The columns that every recording has: time, scalar and the three axes of the fluxgate.
    pub const REQUIRED: [Self; 5] = [Self::Time, Self::Scalar, Self::FluxX, Self::FluxY, Self::FluxZ];

    /// The three axes of the fluxgate.
    pub const FLUX: [Self; 3] = [Self::FluxX, Self::FluxY, Self::FluxZ];

    /// Every known column.
    pub fn all() -> impl Iterator<Item = Self> {
        COLUMNS.iter().map(|spec| spec.column)
    }

    /// What is known of it.
    pub fn spec(self) -> &'static ColumnSpec {
        &COLUMNS[self as usize]
    }

    /// As in a header.
    pub fn name(self) -> &'static str {
        self.spec().name
    }

    /// The known column of this name.
    pub fn named(name: &str) -> Option<Self> {
        COLUMNS.iter().find(|spec| spec.name == name).map(|spec| spec.column)
    }
}

/// The load of a column `current_<load>_A`.
pub fn load_of(name: &str) -> Option<&str> {
    name.strip_prefix("current_")?.strip_suffix("_A").filter(|load| !load.is_empty())
}

const fn number(column: Column, name: &'static str, unit: &'static str) -> ColumnSpec {
    ColumnSpec { column, name, unit, kind: ColumnKind::Number, is_required: false }
}

const fn required(column: Column, name: &'static str, unit: &'static str) -> ColumnSpec {
    ColumnSpec { is_required: true, ..number(column, name, unit) }
}

const fn flag(column: Column, name: &'static str) -> ColumnSpec {
    ColumnSpec { kind: ColumnKind::Flag, ..number(column, name, "") }
}

const fn label(column: Column, name: &'static str) -> ColumnSpec {
    ColumnSpec { kind: ColumnKind::Label, ..number(column, name, "") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_in_the_order_of_the_columns() {
        assert!(COLUMNS.iter().enumerate().all(|(at, spec)| spec.column as usize == at));
        assert!(COLUMNS.iter().all(|spec| Column::named(spec.name) == Some(spec.column)));
        let required = COLUMNS.iter().filter(|spec| spec.is_required).map(|spec| spec.column);
        assert_eq!(required.collect::<Vec<_>>(), Column::REQUIRED);
    }

    #[test]
    fn a_name_ends_in_its_unit() {
        for ColumnSpec { name, unit, .. } in COLUMNS {
            assert!(unit.is_empty() || name.ends_with(&format!("_{}", unit.replace('/', "_per_"))), "{name} {unit}");
        }
    }

    #[test]
    fn loads_are_a_family() {
        assert_eq!(
            ["current_strobe_A", "current__A", "current_A", "current_x"].map(load_of),
            [Some("strobe"), None, None, None]
        );
    }
}
