//! What every task may ask the chip.

use super::reset_cause::reset_cause;
use super::retained_ram;
use super::stack::most_stack_used;
use super::timers::now_us;
use core::marker::PhantomData;
use crc::{CRC_32_ISO_HDLC, Crc, Digest, Table};
use stm32f4xx_hal::pac;
use towmag::body::UnixTime;
use towmag::hardware::{self, LastWords, Stamp};
use towmag::log::ResetCause;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// What boards with this chip differ in.
pub trait Particulars {
    /// A stamp has been taken.
    fn note(stamp: Stamp, stamp_us: u32);

    /// Add the chip's own number, if it has one.
    fn add_unique_number(digest: &mut Digest<'static, u32, Table<1>>);

    /// Start the microcontroller anew.
    fn restart() -> !;

    /// Ticks of SysTick that 100,000 instructions take; 0 where they are clock cycles.
    fn ticks_of_known_loop() -> u32;
}

/// The chip on a board.
pub struct System<P>(PhantomData<P>);

impl<P> System<P> {
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<P> Clone for System<P> {
    fn clone(&self) -> Self {
        Self::new()
    }
}

impl<P: Particulars> hardware::System for System<P> {
    fn now_us(&self) -> u32 {
        now_us()
    }

    fn stamp_us(&self, stamp: Stamp) -> u32 {
        let now_us = now_us();
        P::note(stamp, now_us);
        now_us
    }

    /// Out of how many microseconds the timer has taken to here, and the chip's own number. The timer starts with the chip
    /// and runs on the same crystal, so that two starts may give the same: the log mixes in what it finds on the card.
    fn random(&self, now_us: u32) -> u32 {
        let mut digest = CRC.digest();
        digest.update(&now_us.to_le_bytes());
        P::add_unique_number(&mut digest);
        digest.finalize()
    }

    fn wake_fluxgate(&self) {
        rtic::pend(pac::Interrupt::EXTI9_5);
    }

    fn reset_cause(&self) -> ResetCause {
        reset_cause()
    }

    fn restarts_by_fault(&self) -> u32 {
        retained_ram::faults()
    }

    fn last_words(&self) -> Option<LastWords> {
        retained_ram::last_words()
    }

    fn keep_time(&self, time: Option<UnixTime>) {
        retained_ram::keep_time(time);
    }

    fn kept_time(&self) -> Option<UnixTime> {
        retained_ram::kept_time()
    }

    fn restart(&self) {
        P::restart();
    }

    fn most_stack_used(&self) -> u32 {
        most_stack_used()
    }

    fn ticks_of_known_loop(&self) -> u32 {
        P::ticks_of_known_loop()
    }
}
