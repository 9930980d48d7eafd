//! Last words: the message of a panic or fault, kept over the reset in memory that no start-up code clears.

use core::fmt::Write;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use stm32f4xx_hal::pac;
use towmag::logbook::{ResetCause, TEXT_LEN};

/// The text of a message.
pub type LastWords = heapless::String<TEXT_LEN>;

/// Tells a message from what memory holds after power-up.
const MAGIC: u32 = 0x746D_4C57;

#[repr(C)]
struct Kept {
    magic: u32,
    len: usize,
    text: [u8; TEXT_LEN],
}

#[unsafe(link_section = ".uninit.last_words")]
#[allow(unsafe_code)]
static mut KEPT: MaybeUninit<Kept> = MaybeUninit::uninit();

static RESET_FLAGS: AtomicU32 = AtomicU32::new(0);

/// Keep a message and start again.
fn end_with(message: core::fmt::Arguments<'_>) -> ! {
    cortex_m::interrupt::disable();
    let mut text = LastWords::new();
    _ = text.write_fmt(message); // what does not fit is cut off
    let mut kept = Kept { magic: MAGIC, len: text.len(), text: [0; TEXT_LEN] };
    kept.text[..text.len()].copy_from_slice(text.as_bytes());
    // SAFETY: interrupts are off and this never returns, so nothing else reaches the memory. Volatile, as the compiler
    // sees no one read it.
    #[allow(unsafe_code)]
    unsafe {
        (&raw mut KEPT).write_volatile(MaybeUninit::new(kept));
    }
    SCB::sys_reset()
}

/// The message of the panic or fault that ended the last session, once.
pub fn last_words() -> Option<LastWords> {
    // SAFETY: all bit patterns of `Kept` are valid, and only a panic, which never returns, writes it besides this.
    #[allow(unsafe_code)]
    let kept = unsafe { (&raw const KEPT).read_volatile().assume_init() };
    let wiped = Kept { magic: 0, len: 0, text: [0; TEXT_LEN] };
    // SAFETY: as above.
    #[allow(unsafe_code)]
    unsafe {
        (&raw mut KEPT).write_volatile(MaybeUninit::new(wiped));
    }
    let text = kept.text.get(..kept.len).filter(|_| kept.magic == MAGIC)?;
    LastWords::from_utf8(heapless::Vec::from_slice(text).ok()?).ok()
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
