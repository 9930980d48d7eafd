//! The one free-running timer, and the tick of `assemble`. Both are on the first peripheral bus.

use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use towmag::hardware::{self, TICKS_PER_S};

/// Period of `assemble`, microseconds.
const TICK_US: u16 = (1_000_000 / TICKS_PER_S) as u16;

/// Start TIM2, whose clock runs at `timer_mhz`: it counts microseconds from `first_us` on, and wraps after 71.6 minutes.
pub fn start_stopwatch(timer: pac::TIM2, rcc: &mut Rcc, timer_mhz: u16, first_us: u32) {
    pac::TIM2::enable(rcc);
    pac::TIM2::reset(rcc);
    timer.psc().write(|w| w.psc().set(timer_mhz - 1));
    timer.arr().write(|w| w.arr().set(u32::MAX));
    timer.egr().write(|w| w.ug().set_bit()); // takes the prescaler over
    timer.cnt().write(|w| w.cnt().set(first_us));
    timer.cr1().write(|w| w.cen().set_bit());
}

/// The free-running timer, microseconds.
pub fn now_us() -> u32 {
    // SAFETY: reads the counter of a timer that nothing writes after `start_stopwatch`.
    #[allow(unsafe_code)]
    let timer = unsafe { &*pac::TIM2::ptr() };
    timer.cnt().read().bits()
}

/// TIM4, which calls `assemble`.
pub struct Ticker(pac::TIM4);

impl Ticker {
    /// Start it, with a clock of `timer_mhz`, at `first_us` of its period.
    pub fn start(timer: pac::TIM4, rcc: &mut Rcc, timer_mhz: u16, first_us: u16) -> Self {
        pac::TIM4::enable(rcc);
        pac::TIM4::reset(rcc);
        timer.psc().write(|w| w.psc().set(timer_mhz - 1));
        timer.arr().write(|w| w.arr().set(TICK_US - 1));
        timer.egr().write(|w| w.ug().set_bit());
        timer.cnt().write(|w| w.cnt().set(first_us));
        timer.sr().write(|w| w.uif().clear_bit());
        timer.dier().write(|w| w.uie().set_bit());
        timer.cr1().write(|w| w.cen().set_bit());
        Self(timer)
    }
}

impl hardware::Ticker for Ticker {
    fn acknowledge(&mut self) {
        self.0.sr().write(|w| w.uif().clear_bit());
    }
}
