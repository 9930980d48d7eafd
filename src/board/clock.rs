//! Clocks, the one free-running timer, the tick of `assemble`, and the watchdog.

use embedded_hal::delay::DelayNs;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{self, Enable, Rcc, Reset};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

/// Clock of the timers on the first peripheral bus, MHz.
#[cfg(not(feature = "emulation"))]
const TIMER_MHZ: u16 = 84;
/// QEMU's timers run at 1 GHz whatever the clock registers say.
#[cfg(feature = "emulation")]
const TIMER_MHZ: u16 = 1_000;

/// Crystal of 8 MHz, core at its full 168 MHz.
#[cfg(not(feature = "emulation"))]
pub fn config() -> rcc::Config {
    rcc::Config::hse(8.MHz()).sysclk(168.MHz()).pclk1(42.MHz()).pclk2(84.MHz())
}

/// QEMU has no model of the PLL: waiting for its lock would never end.
#[cfg(feature = "emulation")]
pub fn config() -> rcc::Config {
    rcc::Config::hsi()
}

/// Period of `assemble`, microseconds: the grid wants to be asked at least every 50 ms.
const TICK_US: u16 = 40_000;

/// The watchdog resets when not fed for this long. The card may be busy for half a second.
const WATCHDOG_MS: u32 = 8_000;

/// What a stamp is for. On the board it makes no difference; an emulator's host replays the stamps.
#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "emulation"), allow(dead_code))]
pub enum Source {
    ScalarByte = 1,
    Conversion = 2,
    Poll = 3,
    SetUp = 4,
    Other = 0,
}

/// Start TIM2: it counts microseconds, and wraps after 71.6 minutes.
pub fn start_stopwatch(timer: pac::TIM2, rcc: &mut Rcc) {
    pac::TIM2::enable(rcc);
    pac::TIM2::reset(rcc);
    // Not yet divided, and begun with the emulation: nanoseconds.
    #[cfg(feature = "emulation")]
    let begin_us = timer.cnt().read().bits() / 1_000;
    timer.psc().write(|w| w.psc().set(TIMER_MHZ - 1));
    timer.arr().write(|w| w.arr().set(u32::MAX));
    timer.egr().write(|w| w.ug().set_bit()); // takes the prescaler over
    #[cfg(feature = "emulation")]
    timer.cnt().write(|w| w.cnt().set(begin_us));
    timer.cr1().write(|w| w.cen().set_bit());
}

/// What a timer of QEMU 7.2 must begin to count from: it adds the time of its last beginning to every period, unless that
/// seems to be the emulation's own. So the stopwatch counts from there, and the others from what it shows.
#[cfg(feature = "emulation")]
pub fn first_count() -> u32 {
    now_us()
}

/// The free-running timer, microseconds.
pub fn now_us() -> u32 {
    // SAFETY: reads the counter of a timer that nothing writes after `start_stopwatch`.
    #[allow(unsafe_code)]
    let timer = unsafe { &*pac::TIM2::ptr() };
    timer.cnt().read().bits()
}

/// The free-running timer, microseconds, for a stamp that the grid sees.
pub fn stamp_us(source: Source) -> u32 {
    let now_us = now_us();
    #[cfg(feature = "emulation")]
    super::bridge::note(source, now_us);
    #[cfg(not(feature = "emulation"))]
    let _ = source;
    now_us
}

/// Waits by looking at the timer: for the converter's reset only, a millisecond.
pub struct SpinDelay;

impl DelayNs for SpinDelay {
    fn delay_ns(&mut self, ns: u32) {
        let begin_us = now_us();
        while now_us().wrapping_sub(begin_us) <= ns.div_ceil(1_000) {}
    }
}

/// TIM4, which calls `assemble`.
pub struct Ticker(pac::TIM4);

impl Ticker {
    pub fn start(timer: pac::TIM4, rcc: &mut Rcc) -> Self {
        pac::TIM4::enable(rcc);
        pac::TIM4::reset(rcc);
        timer.psc().write(|w| w.psc().set(TIMER_MHZ - 1));
        timer.arr().write(|w| w.arr().set(TICK_US - 1));
        timer.egr().write(|w| w.ug().set_bit());
        #[cfg(feature = "emulation")]
        timer.cnt().write(|w| w.cnt().set(first_count() as u16));
        timer.sr().write(|w| w.uif().clear_bit());
        timer.dier().write(|w| w.uie().set_bit());
        timer.cr1().write(|w| w.cen().set_bit());
        Self(timer)
    }

    pub fn acknowledge(&mut self) {
        self.0.sr().write(|w| w.uif().clear_bit());
    }
}

/// The independent watchdog.
pub struct Watchdog(IndependentWatchdog);

impl Watchdog {
    pub fn start(iwdg: pac::IWDG) -> Self {
        let mut watchdog = IndependentWatchdog::new(iwdg);
        watchdog.start(WATCHDOG_MS.millis());
        Self(watchdog)
    }

    pub fn feed_if(&mut self, all_ran: bool) {
        if all_ran {
            self.0.feed();
        }
    }
}
