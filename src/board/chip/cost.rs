//! What an epoch costs: SysTick between waking up and going to sleep again, everything in between included.
//!
//! On the board these are clock cycles. Under emulation they stand for instructions, see `firmware/figures.toml`.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use towmag::hardware::{self, EpochCost};

/// SysTick has 24 bits: no stretch between two sleeps may be longer, 100 ms at 168 MHz.
const MASK: u32 = 0x00FF_FFFF;

/// Epochs until the costs count: the start sets up the converter and looks for the card.
const WARM_UP_EPOCHS: u32 = 50;

/// SysTick, which counts down.
pub fn now() -> u32 {
    SYST::get_current()
}

/// Ticks since SysTick was `begin`.
pub fn since(begin: u32) -> u32 {
    begin.wrapping_sub(now()) & MASK
}

/// Adds up what is spent between two sleeps.
pub struct Meter {
    /// Ticks since the start that a board would not have spent.
    waited: fn() -> u32,
    woke: u32,
    waited_before: u32,
    epochs: u32,
    busy: u32,
    sum: u64,
    counted: u32,
    worst: u32,
}

impl Meter {
    /// Start SysTick. What `waited` says is not counted.
    pub fn start(mut syst: SYST, waited: fn() -> u32) -> Self {
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(MASK);
        syst.clear_current();
        syst.enable_counter();
        Self { waited, woke: now(), waited_before: 0, epochs: 0, busy: 0, sum: 0, counted: 0, worst: 0 }
    }

    fn close(&mut self, epochs: u32) -> Option<EpochCost> {
        let made = epochs.wrapping_sub(self.epochs);
        let each = self.busy / made.max(1);
        (self.epochs, self.busy) = (epochs, 0);
        if epochs < WARM_UP_EPOCHS {
            return None;
        }
        self.worst = self.worst.max(each);
        self.sum += u64::from(each) * u64::from(made);
        self.counted = self.counted.saturating_add(made);
        Some(EpochCost { mean: (self.sum / u64::from(self.counted.max(1))) as u32, worst: self.worst })
    }
}

impl hardware::Meter for Meter {
    fn sleep(&mut self, epochs: u32, tell: impl FnOnce(EpochCost)) {
        // Without interrupts, so that none comes between the look at the clock and the sleep; a pending one ends it.
        cortex_m::interrupt::disable();
        let waited = (self.waited)();
        let busy = since(self.woke).wrapping_sub(waited.wrapping_sub(self.waited_before));
        self.waited_before = waited;
        self.busy = self.busy.wrapping_add(busy);
        if epochs != self.epochs {
            self.close(epochs).map(tell);
        }
        cortex_m::asm::wfi();
        self.woke = now();
        // SAFETY: nothing in this function relies on interrupts being off; idle runs with them on.
        #[allow(unsafe_code)]
        unsafe {
            cortex_m::interrupt::enable();
        }
    }
}
