//! Why the microcontroller has started.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use stm32f4xx_hal::pac;
use towmag::log::ResetCause;

static RESET_FLAGS: AtomicU32 = AtomicU32::new(0);

/// Look why this start happened, and clear the flags for the next.
pub fn note_reset_cause(rcc: &pac::RCC) {
    RESET_FLAGS.store(rcc.csr().read().bits(), Relaxed);
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
}

/// Why the microcontroller started.
pub fn reset_cause() -> ResetCause {
    let flag = |bit: u32| RESET_FLAGS.load(Relaxed) & 1 << bit != 0;
    // Every cause sets the pin's flag as well, and power-on that of the brown-out: the special ones first.
    [
        (31, ResetCause::LowPower),
        (30, ResetCause::Watchdog),
        (29, ResetCause::Watchdog),
        (28, ResetCause::Software),
        (27, ResetCause::PowerOn),
        (25, ResetCause::BrownOut),
        (26, ResetCause::Pin),
    ]
    .into_iter()
    .find(|(bit, _)| flag(*bit))
    .map_or(ResetCause::Unknown, |(_, cause)| cause)
}
