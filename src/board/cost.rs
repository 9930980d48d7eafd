//! What an epoch costs: SysTick between waking up and going to sleep again, everything in between included.
//!
//! On the board these are clock cycles. Under emulation they stand for instructions, see `firmware/figures.toml`.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// SysTick has 24 bits: no stretch between two sleeps may be longer, 100 ms at 168 MHz.
const MASK: u32 = 0x00FF_FFFF;

/// Epochs until the costs count: the start sets up the converter and looks for the card.
const WARM_UP_EPOCHS: u32 = 50;

/// Spent by what interrupts a wait for the emulator's host.
static PREEMPTING: AtomicU32 = AtomicU32::new(0);

/// Spent waiting for the emulator's host.
static WAITED: AtomicU32 = AtomicU32::new(0);

fn now() -> u32 {
    SYST::get_current()
}

/// From `begin`, which counts down, until now.
fn since(begin: u32) -> u32 {
    begin.wrapping_sub(now()) & MASK
}

/// The work of a task that may interrupt a [`Wait`].
pub struct Preempting(u32);

impl Preempting {
    pub fn begin() -> Self {
        Self(now())
    }

    pub fn end(self) {
        PREEMPTING.fetch_add(since(self.0), Relaxed);
    }
}

/// A wait that there would not be on the board.
#[cfg(feature = "emulation")]
pub struct Wait {
    begin: u32,
    preempting: u32,
}

#[cfg(feature = "emulation")]
impl Wait {
    pub fn begin() -> Self {
        Self { begin: now(), preempting: PREEMPTING.load(Relaxed) }
    }

    pub fn end(self) {
        let preempted = PREEMPTING.load(Relaxed).wrapping_sub(self.preempting);
        WAITED.fetch_add(since(self.begin).wrapping_sub(preempted), Relaxed);
    }
}

/// What SysTick makes of 100,000 instructions: under emulation it counts time, and an instruction takes a nanosecond.
#[cfg(feature = "emulation")]
fn count_known_loop() {
    let begin = now();
    // SAFETY: counts a register of its own down to zero, two instructions a turn.
    #[allow(unsafe_code)]
    unsafe {
        core::arch::asm!("2: subs {n}, #1", "bne 2b", n = inout(reg) 50_000_u32 => _, options(nomem, nostack));
    }
    TICKS_OF_KNOWN_LOOP.store(since(begin), Relaxed);
}

/// Ticks that 100,000 instructions take; 0 on the board, where ticks are cycles.
static TICKS_OF_KNOWN_LOOP: AtomicU32 = AtomicU32::new(0);

/// Ticks that 100,000 instructions take; 0 on the board, where ticks are cycles.
pub fn ticks_of_known_loop() -> u32 {
    TICKS_OF_KNOWN_LOOP.load(Relaxed)
}

/// Adds up what is spent between two sleeps.
pub struct Meter {
    woke: u32,
    waited: u32,
    epochs: u32,
    busy: u32,
    sum: u64,
    counted: u32,
    worst: u32,
}

impl Meter {
    pub fn start(mut syst: SYST) -> Self {
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(MASK);
        syst.clear_current();
        syst.enable_counter();
        #[cfg(feature = "emulation")]
        count_known_loop();
        Self { woke: now(), waited: 0, epochs: 0, busy: 0, sum: 0, counted: 0, worst: 0 }
    }

    /// Sleep until an interrupt. `epochs` have been made so far.
    pub fn sleep(&mut self, epochs: u32) {
        // Without interrupts, so that none comes between the look at the clock and the sleep; a pending one ends it.
        cortex_m::interrupt::disable();
        let waited = WAITED.load(Relaxed);
        let busy = since(self.woke).wrapping_sub(waited.wrapping_sub(self.waited));
        self.waited = waited;
        self.busy = self.busy.wrapping_add(busy);
        if epochs != self.epochs {
            self.close(epochs);
        }
        cortex_m::asm::wfi();
        self.woke = now();
        // SAFETY: nothing in this function relies on interrupts being off; idle runs with them on.
        #[allow(unsafe_code)]
        unsafe {
            cortex_m::interrupt::enable();
        }
    }

    fn close(&mut self, epochs: u32) {
        let made = epochs.wrapping_sub(self.epochs);
        let each = self.busy / made.max(1);
        (self.epochs, self.busy) = (epochs, 0);
        if epochs < WARM_UP_EPOCHS {
            return;
        }
        self.worst = self.worst.max(each);
        self.sum += u64::from(each) * u64::from(made);
        self.counted = self.counted.saturating_add(made);
        crate::status::STATUS.set_cost((self.sum / u64::from(self.counted.max(1))) as u32, self.worst);
    }
}
