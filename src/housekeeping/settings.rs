//! What is set about leak contact and battery.

use crate::sensors::check;
use crate::settings::SettingsError;

/// What is fitted, and when the battery is low.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HousekeepingSettings {
    /// Voltage of the battery for a count of the chip's converter, V, 0 to 0.1; 0 where it is not measured. With the divider
    /// of 11 to 1 and a supply of 3.3 V: 3.3 V / 4,096 * 11 = 0.00886 V.
    pub battery_v_per_count: f64,
    /// The battery is low below this, V, 0 to 100; 0 for no warning.
    pub battery_low_v: f64,
    /// Whether a leak contact is fitted.
    pub is_leak_fitted: bool,
}

impl Default for HousekeepingSettings {
    /// Neither is fitted.
    fn default() -> Self {
        Self { battery_v_per_count: 0.0, battery_low_v: 0.0, is_leak_fitted: false }
    }
}

impl HousekeepingSettings {
    /// Check every number against its range.
    pub fn validate(&self) -> Result<(), SettingsError> {
        check("battery_v_per_count", self.battery_v_per_count, 0.0..=0.1, "0 to 0.1")?;
        check("battery_low_v", self.battery_low_v, 0.0..=100.0, "0 to 100")
    }

    /// Whether the voltage of the battery is measured.
    pub(super) fn is_battery_fitted(&self) -> bool {
        self.battery_v_per_count > 0.0
    }
}
