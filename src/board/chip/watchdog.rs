//! The independent watchdog.

use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::watchdog::IndependentWatchdog;
use towmag::hardware;

/// The watchdog resets when not fed for this long. The card may be busy for half a second.
const PERIOD_MS: u32 = 8_000;

/// The independent watchdog.
pub struct Watchdog(IndependentWatchdog);

impl Watchdog {
    pub fn start(iwdg: pac::IWDG) -> Self {
        let mut watchdog = IndependentWatchdog::new(iwdg);
        watchdog.start(PERIOD_MS.millis());
        Self(watchdog)
    }
}

impl hardware::Watchdog for Watchdog {
    fn feed(&mut self) {
        self.0.feed();
    }
}
