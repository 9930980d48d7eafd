//! What the emulator adds to the cost of an epoch, and how instructions are told from its ticks.

use crate::board::chip::cost::{now, since};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Spent by what interrupts a wait for the emulator's host.
static PREEMPTING: AtomicU32 = AtomicU32::new(0);

/// Spent waiting for the emulator's host.
static WAITED: AtomicU32 = AtomicU32::new(0);

/// Ticks that 100,000 instructions take.
static TICKS_OF_KNOWN_LOOP: AtomicU32 = AtomicU32::new(0);

/// The work of an interrupt that may come into a [`Wait`].
pub struct Preempting(u32);

impl Preempting {
    pub fn begin() -> Self {
        Self(now())
    }

    pub fn end(self) {
        PREEMPTING.fetch_add(since(self.0), Relaxed);
    }
}

/// A wait that there would not be on a board.
pub struct Wait {
    begin: u32,
    preempting: u32,
}

impl Wait {
    pub fn begin() -> Self {
        Self { begin: now(), preempting: PREEMPTING.load(Relaxed) }
    }

    pub fn end(self) {
        let preempted = PREEMPTING.load(Relaxed).wrapping_sub(self.preempting);
        WAITED.fetch_add(since(self.begin).wrapping_sub(preempted), Relaxed);
    }
}

/// Ticks spent in waits since the start.
pub fn waited() -> u32 {
    WAITED.load(Relaxed)
}

/// Measure what SysTick makes of 100,000 instructions: it counts time, and an instruction takes a nanosecond.
pub fn count_known_loop() {
    let begin = now();
    // SAFETY: counts a register of its own down to zero, two instructions a turn.
    #[allow(unsafe_code)]
    unsafe {
        core::arch::asm!("2: subs {n}, #1", "bne 2b", n = inout(reg) 50_000_u32 => _, options(nomem, nostack));
    }
    TICKS_OF_KNOWN_LOOP.store(since(begin), Relaxed);
}

/// Ticks that 100,000 instructions take.
pub fn ticks_of_known_loop() -> u32 {
    TICKS_OF_KNOWN_LOOP.load(Relaxed)
}
