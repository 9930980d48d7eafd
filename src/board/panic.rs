//! Why the microcontroller starts, and how it ends: panics and faults leave their message and start it anew.

use super::kept;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m_rt::{ExceptionFrame, exception};
use stm32f4xx_hal::pac;
use towmag::log::ResetCause;

static RESET_FLAGS: AtomicU32 = AtomicU32::new(0);

/// Keep a message and start again.
fn end_with(message: core::fmt::Arguments<'_>) -> ! {
    cortex_m::interrupt::disable();
    kept::leave_last_words(message);
    kept::restart()
}

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

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    match info.location() {
        Some(location) => end_with(format_args!("{}:{}: {}", location.file(), location.line(), info.message())),
        None => end_with(format_args!("{}", info.message())),
    }
}

#[exception]
#[allow(unsafe_code)]
// SAFETY: a fault handler must be unsafe as it may run anywhere; this one touches nothing but the kept message.
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    end_with(format_args!("hard fault at {:08x}, called from {:08x}", frame.pc(), frame.lr()))
}

#[exception]
#[allow(unsafe_code)]
// SAFETY: as above.
unsafe fn DefaultHandler(number: i16) {
    end_with(format_args!("interrupt {number} has no handler"))
}
