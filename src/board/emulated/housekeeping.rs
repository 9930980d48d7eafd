//! Leak contact and battery, as the host has told them last.

use super::cost::Wait;
use super::protocol;
use towmag::hardware;
use towmag::housekeeping::HousekeepingSample;

/// Leak contact and battery.
pub struct HousekeepingInputs;

impl hardware::HousekeepingInputs for HousekeepingInputs {
    fn sample(&mut self) -> HousekeepingSample {
        // A board reads two registers.
        let wait = Wait::begin();
        let sample = protocol::housekeeping();
        wait.end();
        sample
    }
}
