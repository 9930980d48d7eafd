//! The independent watchdog, which the board has started.

use stm32f4xx_hal::pac;
use towmag::hardware;

/// For IWDG_KR: count anew.
const FEED: u16 = 0xAAAA;

/// The independent watchdog.
pub struct Watchdog(pub pac::IWDG);

impl hardware::Watchdog for Watchdog {
    fn feed(&mut self) {
        // SAFETY: one of the register's three keys.
        #[allow(unsafe_code)]
        self.0.kr().write(|w| unsafe { w.key().bits(FEED) });
    }
}
