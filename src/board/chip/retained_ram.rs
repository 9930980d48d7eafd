//! Memory that no start-up code clears: what outlives a reset, but not the power.

use core::mem::MaybeUninit;
use cortex_m::interrupt;
use towmag::body::UnixTime;
use towmag::hardware::LastWords;
use towmag::log::{ResetCause, TEXT_LEN};

/// Tells what was retained from what memory holds after power-up.
const MAGIC: u32 = 0x746D_4C58;

/// All bit patterns of it are valid.
#[derive(Clone, Copy)]
#[repr(C)]
struct Retained {
    magic: u32,
    /// Panics, hard faults and resets by the watchdog since power came.
    faults: u32,
    /// Time of the latest epoch, microseconds since 1970-01-01 UTC, and its error; 0 when not known.
    unix_us: u64,
    error_us: u32,
    /// Bytes of the text.
    len: usize,
    text: [u8; TEXT_LEN],
}

const NOTHING: Retained = Retained { magic: MAGIC, faults: 0, unix_us: 0, error_us: 0, len: 0, text: [0; TEXT_LEN] };

#[unsafe(link_section = ".uninit.retained")]
#[allow(unsafe_code)]
static mut RETAINED: MaybeUninit<Retained> = MaybeUninit::uninit();

/// Look at what was retained, and change it.
fn with<T>(change: impl FnOnce(&mut Retained) -> T) -> T {
    interrupt::free(|_| {
        // SAFETY: nothing but this function reaches the memory, and nothing interrupts it. Volatile, as the compiler
        // sees no one read what is left for the time after a reset. All bit patterns are valid.
        #[allow(unsafe_code)]
        let mut retained = unsafe { (&raw const RETAINED).read_volatile().assume_init() };
        if retained.magic != MAGIC {
            retained = NOTHING;
        }
        let result = change(&mut retained);
        // SAFETY: as above.
        #[allow(unsafe_code)]
        unsafe {
            (&raw mut RETAINED).write_volatile(MaybeUninit::new(retained));
        }
        result
    })
}

/// First of all after a start. `restore` puts back what the memory held, where a reset does not leave it alone.
pub fn begin(cause: ResetCause, restore: impl FnOnce(&mut [u8])) {
    // SAFETY: called before interrupts are on; all bytes are initialised memory.
    #[allow(unsafe_code)]
    restore(unsafe { core::slice::from_raw_parts_mut((&raw mut RETAINED).cast::<u8>(), size_of::<Retained>()) });
    with(|retained| retained.faults += u32::from(cause == ResetCause::Watchdog));
}

/// Last of all before a reset. `save` puts away what the memory holds, where a reset does not leave it alone.
pub fn end(save: impl FnOnce(&[u8])) {
    interrupt::disable();
    // SAFETY: interrupts are off for good; all bytes are initialised memory.
    #[allow(unsafe_code)]
    save(unsafe { core::slice::from_raw_parts((&raw const RETAINED).cast::<u8>(), size_of::<Retained>()) });
}

/// Panics, hard faults and resets by the watchdog since power came.
pub fn faults() -> u32 {
    with(|retained| retained.faults)
}

/// Leave the message of a panic or fault for the next session; what does not fit is cut off.
pub fn leave_last_words(message: core::fmt::Arguments<'_>) {
    let mut text = LastWords::new();
    _ = core::fmt::Write::write_fmt(&mut text, message);
    with(|retained| {
        retained.faults = retained.faults.wrapping_add(1);
        retained.len = text.len();
        retained.text[..text.len()].copy_from_slice(text.as_bytes());
    });
}

/// The message of the panic or fault that ended the last session, once.
pub fn last_words() -> Option<LastWords> {
    let (text, len) = with(|retained| (retained.text, core::mem::take(&mut retained.len)));
    let text = heapless::Vec::from_slice(text.get(..len).filter(|text| !text.is_empty())?).ok()?;
    LastWords::from_utf8(text).ok()
}

/// Keep the time for the session after the next reset.
pub fn keep_time(time: Option<UnixTime>) {
    let UnixTime { unix_us, error_us } = time.unwrap_or(UnixTime { unix_us: 0, error_us: 0 });
    interrupt::free(|_| {
        let retained = (&raw mut RETAINED).cast::<Retained>();
        // SAFETY: as in `with`, but for these two alone, since it is done at every epoch; `begin` has made the rest valid.
        #[allow(unsafe_code)]
        unsafe {
            (&raw mut (*retained).unix_us).write_volatile(unix_us);
            (&raw mut (*retained).error_us).write_volatile(error_us);
        }
    });
}

/// The time that was kept, once.
pub fn kept_time() -> Option<UnixTime> {
    let kept =
        with(|retained| UnixTime { unix_us: core::mem::take(&mut retained.unix_us), error_us: retained.error_us });
    Some(kept).filter(|kept| kept.unix_us > 0)
}
