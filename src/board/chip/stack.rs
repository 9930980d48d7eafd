//! How much of the stack is used.

use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// What untouched stack holds.
const PAINT: u32 = 0x5741_5341;

/// Left alone below the stack pointer while painting: this function's own frame.
const MARGIN_WORDS: usize = 64;

#[allow(unsafe_code)]
unsafe extern "C" {
    static _stack_start: u32;
}

/// Lowest address of the stack, and of the memory: see `memory.x`.
const STACK_BOTTOM: usize = 0x2000_0000;

/// Painted words in a row that show that the stack has never been this deep.
const UNTOUCHED_WORDS: usize = 128;

/// Deepest address of the stack seen so far; 0 before the first look.
static DEEPEST: AtomicUsize = AtomicUsize::new(0);

/// Fill the unused stack, to see later how much of it was needed.
pub fn paint_stack() {
    let mut word = STACK_BOTTOM as *mut u32;
    // SAFETY: from the lowest address of the stack to well below this function's frame nothing is in use, and no
    // interrupt is enabled yet that could use it meanwhile.
    #[allow(unsafe_code)]
    unsafe {
        let end = (cortex_m::register::msp::read() as *mut u32).sub(MARGIN_WORDS);
        while word < end {
            word.write_volatile(PAINT);
            word = word.add(1);
        }
    }
}

/// The most stack that was ever in use, bytes. Looks on from where it was last: the whole would take a millisecond.
pub fn most_stack_used() -> u32 {
    let start = (&raw const _stack_start) as usize;
    let mut deepest = DEEPEST.load(Relaxed);
    if deepest == 0 {
        deepest = cortex_m::register::msp::read() as usize & !3;
    }
    let mut word = deepest;
    let mut untouched = 0;
    while untouched < UNTOUCHED_WORDS && word > STACK_BOTTOM {
        word -= size_of::<u32>();
        // SAFETY: an aligned address between the two ends of the stack, all of which is memory.
        #[allow(unsafe_code)]
        let is_painted = unsafe { (word as *const u32).read_volatile() } == PAINT;
        untouched = if is_painted { untouched + 1 } else { 0 };
        if !is_painted {
            deepest = word;
        }
    }
    DEEPEST.store(deepest, Relaxed);
    (start - deepest) as u32
}
