//! How a session ends that should not: panics and faults leave their message and start the microcontroller anew.

use super::chip::retained_ram;
use cortex_m_rt::{ExceptionFrame, exception};

/// Keep a message and start again.
fn end_with(message: core::fmt::Arguments<'_>) -> ! {
    cortex_m::interrupt::disable();
    retained_ram::leave_last_words(message);
    super::restart()
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
