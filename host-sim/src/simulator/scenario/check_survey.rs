//! What a survey needs of a scenario.

use super::range::within;
use super::{Columns, Scenario};

impl Scenario {
    /// What needs a speed or a place has it.
    pub(super) fn check_survey(&self) -> Result<(), String> {
        let Columns { position, altitude, speed, utc, .. } = self.columns;
        let has_place = self.field.latitude_deg.is_some();
        let lacks_speed = self.motion.speed_m_per_s().is_none();
        if lacks_speed && (position || speed || self.ship.is_some() || !self.dipoles.is_empty()) {
            return Err(
                "motion.speed_m_per_s: is needed for [[dipole]], [ship], columns.position and columns.speed".into()
            );
        }
        if !has_place && (position || utc) {
            return Err("field: columns.position and columns.utc need latitude_deg, longitude_deg and date".into());
        }
        if utc {
            self.field.first_utc_s()?;
        }
        if altitude && self.bottom.is_none() {
            return Err("bottom.depth_m: is needed for columns.altitude".into());
        }
        if let Some(bottom) = &self.bottom {
            within("bottom.depth_m", bottom.depth_m, 0.0..=12_000.0)?;
        }
        if let Some(ship) = &self.ship {
            within("ship.cable_out_m", ship.cable_out_m, 0.0..=10_000.0)?;
        }
        self.dipoles.iter().try_for_each(|dipole| dipole.check(has_place))
    }
}
