//! Memory that no start-up code clears: what outlives a reset, but not the power.

use core::mem::MaybeUninit;
use cortex_m::interrupt;
use towmag::log::{ResetCause, TEXT_LEN};

/// The text of a message.
pub type LastWords = heapless::String<TEXT_LEN>;

/// Tells what was kept from what memory holds after power-up.
const MAGIC: u32 = 0x746D_4C58;

/// All bit patterns of it are valid.
#[derive(Clone, Copy)]
#[repr(C)]
struct Kept {
    magic: u32,
    /// Panics, hard faults and resets by the watchdog since power came.
    faults: u32,
    /// Time at an orderly restart, milliseconds since 1970-01-01 UTC; 0 when not known.
    unix_ms: u64,
    /// Bytes of the text.
    len: usize,
    text: [u8; TEXT_LEN],
}

const NOTHING: Kept = Kept { magic: MAGIC, faults: 0, unix_ms: 0, len: 0, text: [0; TEXT_LEN] };

#[unsafe(link_section = ".uninit.kept")]
#[allow(unsafe_code)]
static mut KEPT: MaybeUninit<Kept> = MaybeUninit::uninit();

/// Look at what was kept, and change it.
fn with<T>(change: impl FnOnce(&mut Kept) -> T) -> T {
    interrupt::free(|_| {
        // SAFETY: nothing but this function reaches the memory, and nothing interrupts it. Volatile, as the compiler
        // sees no one read what is left for the time after a reset. All bit patterns are valid.
        #[allow(unsafe_code)]
        let mut kept = unsafe { (&raw const KEPT).read_volatile().assume_init() };
        if kept.magic != MAGIC {
            kept = NOTHING;
        }
        let result = change(&mut kept);
        // SAFETY: as above.
        #[allow(unsafe_code)]
        unsafe {
            (&raw mut KEPT).write_volatile(MaybeUninit::new(kept));
        }
        result
    })
}

/// First of all after a start.
pub fn begin(cause: ResetCause) {
    #[cfg(feature = "emulation")]
    super::bridge::load_kept(memory());
    with(|kept| kept.faults += u32::from(cause == ResetCause::Watchdog));
}

/// Panics, hard faults and resets by the watchdog since power came.
pub fn faults() -> u32 {
    with(|kept| kept.faults)
}

/// Leave the message of a panic or fault for the next session; what does not fit is cut off.
pub fn leave_last_words(message: core::fmt::Arguments<'_>) {
    let mut text = LastWords::new();
    _ = core::fmt::Write::write_fmt(&mut text, message);
    with(|kept| {
        kept.faults = kept.faults.wrapping_add(1);
        kept.len = text.len();
        kept.text[..text.len()].copy_from_slice(text.as_bytes());
    });
}

/// The message of the panic or fault that ended the last session, once.
pub fn last_words() -> Option<LastWords> {
    let (text, len) = with(|kept| (kept.text, core::mem::take(&mut kept.len)));
    let text = heapless::Vec::from_slice(text.get(..len).filter(|text| !text.is_empty())?).ok()?;
    LastWords::from_utf8(text).ok()
}

/// Leave the time, milliseconds since 1970-01-01 UTC, for the session after an orderly restart.
pub fn leave_time(unix_ms: Option<u64>) {
    with(|kept| kept.unix_ms = unix_ms.unwrap_or(0));
}

/// The time that was left, once; it is that of the restart, a fraction of a second ago.
pub fn time() -> Option<u64> {
    Some(with(|kept| core::mem::take(&mut kept.unix_ms))).filter(|&unix_ms| unix_ms > 0)
}

/// Start the microcontroller anew.
pub fn restart() -> ! {
    interrupt::disable();
    #[cfg(feature = "emulation")]
    super::bridge::end_life(memory());
    #[cfg(not(feature = "emulation"))]
    cortex_m::peripheral::SCB::sys_reset()
}

/// The bytes of it, for the emulator's host, which ends the emulator where a board resets its chip.
#[cfg(feature = "emulation")]
fn memory() -> &'static mut [u8] {
    // SAFETY: called before interrupts are on, and after they are off for good; all bytes are initialised memory.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts_mut((&raw mut KEPT).cast::<u8>(), size_of::<Kept>())
    }
}
