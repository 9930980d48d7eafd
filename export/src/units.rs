//! The unit of a column.

use towmag_recording::{COLUMNS, Column, LOAD_UNIT, load_of};

/// Its unit as the contract has it, or else as its name ends: `interference_nT` is in nT.
pub(crate) fn unit_of(name: &str) -> &'static str {
    if let Some(column) = Column::named(name) {
        return column.spec().unit;
    }
    if load_of(name).is_some() {
        return LOAD_UNIT;
    }
    // The longest, for `_m_per_s` ends in `_s` too.
    let units = COLUMNS.iter().map(|spec| spec.unit).filter(|unit| !unit.is_empty());
    units.filter(|unit| name.ends_with(&suffix(unit))).max_by_key(|unit| unit.len()).unwrap_or("")
}

fn suffix(unit: &str) -> String {
    format!("_{}", unit.replace('/', "_per_"))
}

#[cfg(test)]
mod tests {
    use super::unit_of;

    #[test]
    fn a_name_tells_its_unit() {
        for (name, unit) in [
            ("scalar_nT", "nT"),
            ("speed_m_per_s", "m/s"),
            ("drift_m_per_s", "m/s"),
            ("current_strobe_A", "A"),
            ("predicted_std_nT", "nT"),
            ("scalar_valid", ""),
            ("heading_magnetic_deg", "deg"),
            ("adapted_share", ""),
        ] {
            assert_eq!(unit_of(name), unit, "{name}");
        }
    }
}
