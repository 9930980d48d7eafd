//! Leak contact and battery, as the host has told them last.

use super::protocol;
use towmag::hardware;
use towmag::housekeeping::HousekeepingSample;

/// Leak contact and battery.
pub struct HousekeepingInputs;

impl hardware::HousekeepingInputs for HousekeepingInputs {
    fn sample(&mut self) -> HousekeepingSample {
        protocol::housekeeping()
    }
}
