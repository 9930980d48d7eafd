//! From the crystal when it is there and has 8 MHz, else from the internal oscillator. What decides is in
//! [`towmag::microcontroller`].
//!
//! The core starts on the internal oscillator. Then the crystal gets its time to start, and the core runs from it for some
//! milliseconds: TIM5, which follows the core, counts the same number of periods of the low-speed oscillator on both.

use crate::board::chip::retained_ram;
use core::mem::MaybeUninit;
use cortex_m_rt::exception;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{self, Enable, Rcc, Reset};
use towmag::microcontroller::{
    COUNTED_PERIODS, ClockCheck, ClockFault, ClockPlan, ON_CRYSTAL, ON_INTERNAL, judge_crystal,
};

/// What a crystal may take to start, in ticks of the internal oscillator: 100 ms. Usual are two.
const START_TICKS: u32 = 1_600_000;

/// For all captures of one count, in ticks of 8 to 26 MHz: 15 ms or more, against 4.3 ms with 17 kHz.
const COUNT_TICKS: u32 = 400_000;

/// Counted captures; each takes eight periods of the low-speed oscillator.
const CAPTURES: u32 = COUNTED_PERIODS / 8;

/// Looks at the register until the core has changed its clock: some cycles of either.
const SWITCH_LOOKS: u32 = 10_000;

/// In [`STOPPED`]: the crystal has stopped since power came.
const HAS_STOPPED: u32 = 0x5354_4F50;

/// No start-up code clears it, and without power it holds something else.
#[unsafe(link_section = ".uninit.crystal_stopped")]
#[allow(unsafe_code)]
static mut STOPPED: MaybeUninit<u32> = MaybeUninit::uninit();

/// Set up the clocks, and tell what was found out about them.
pub fn start(mut rcc: pac::RCC, timer: &pac::TIM5) -> (Rcc, ClockCheck) {
    let check =
        try_crystal(&mut rcc, timer).unwrap_or_else(|fault| ClockCheck { fault: Some(fault), ..ClockCheck::default() });
    let plan = plan(check.fault);
    let source = if check.fault.is_some() { rcc::Config::hsi() } else { rcc::Config::hse(8.MHz()) };
    let ClockPlan { core_mhz, bus_1_mhz, bus_2_mhz } = plan;
    (rcc.freeze(source.sysclk(core_mhz.MHz()).pclk1(bus_1_mhz.MHz()).pclk2(bus_2_mhz.MHz())), check)
}

/// Clock of the timers on the first peripheral bus, MHz.
pub fn timer_mhz(fault: Option<ClockFault>) -> u16 {
    2 * plan(fault).bus_1_mhz as u16
}

fn plan(fault: Option<ClockFault>) -> ClockPlan {
    if fault.is_some() { ON_INTERNAL } else { ON_CRYSTAL }
}

/// Start the crystal and measure it. It runs afterwards, watched, when it is good, and not when it is not.
fn try_crystal(rcc: &mut pac::RCC, timer: &pac::TIM5) -> Result<ClockCheck, ClockFault> {
    if has_stopped() {
        return Err(ClockFault::Stopped);
    }
    pac::TIM5::enable(rcc);
    pac::TIM5::reset(rcc);
    let measured = measure(rcc, timer);
    pac::TIM5::reset(rcc);
    let is_good = measured.is_ok_and(|check| check.fault.is_none());
    if !is_good {
        rcc.cr().modify(|_, w| w.csson().clear_bit());
        rcc.cr().modify(|_, w| w.hseon().clear_bit());
    }
    measured
}

fn measure(rcc: &pac::RCC, timer: &pac::TIM5) -> Result<ClockCheck, ClockFault> {
    prepare(rcc, timer);
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    while rcc.cr().read().hserdy().bit_is_clear() {
        if timer.cnt().read().bits() > START_TICKS {
            return Err(ClockFault::DoesNotStart);
        }
    }
    let internal_ticks = count(timer)?;
    // From here on a crystal that stops ends in `NonMaskableInt`, on the internal oscillator.
    rcc.cr().modify(|_, w| w.csson().set_bit());
    switch(rcc, true)?;
    let crystal_ticks = count(timer);
    switch(rcc, false)?;
    Ok(judge_crystal(internal_ticks, crystal_ticks?))
}

/// TIM5 counts the core's clock, and notes the count at every eighth edge of the low-speed oscillator.
fn prepare(rcc: &pac::RCC, timer: &pac::TIM5) {
    rcc.csr().modify(|_, w| w.lsion().set_bit());
    // SAFETY: the values are those of the reference manual RM0090 for input 4: from the low-speed oscillator (TIM5_OR),
    // as it comes, every eighth rising edge (TIM5_CCMR2).
    #[allow(unsafe_code)]
    unsafe {
        timer.or().write(|w| w.bits(0b01 << 6));
        timer.ccmr2_input().write(|w| w.bits((0b11 << 10) | (0b01 << 8)));
    }
    timer.arr().write(|w| w.arr().set(u32::MAX));
    timer.ccer().write(|w| w.cc4e().set_bit());
    timer.cr1().write(|w| w.cen().set_bit());
}

/// Ticks of the timer over [`CAPTURES`].
fn count(timer: &pac::TIM5) -> Result<u32, ClockFault> {
    let begin = timer.cnt().read().bits();
    // What was captured before is of another clock.
    _ = timer.ccr4().read();
    let capture = || {
        while timer.sr().read().cc4if().bit_is_clear() {
            if timer.cnt().read().bits().wrapping_sub(begin) > COUNT_TICKS {
                return Err(ClockFault::NotMeasured);
            }
        }
        // Reading clears the flag.
        Ok(timer.ccr4().read().bits())
    };
    // The first stretch after a change of the clock is a mixture.
    capture()?;
    let first = capture()?;
    let mut last = first;
    for _ in 0..CAPTURES {
        last = capture()?;
    }
    Ok(last.wrapping_sub(first))
}

/// Let the core run from the crystal, or from the internal oscillator.
fn switch(rcc: &pac::RCC, to_crystal: bool) -> Result<(), ClockFault> {
    rcc.cfgr().modify(|_, w| if to_crystal { w.sw().hse() } else { w.sw().hsi() });
    let mut looks = 0..SWITCH_LOOKS;
    looks.find(|_| rcc.cfgr().read().sws().is_hse() == to_crystal).map(drop).ok_or(ClockFault::NotMeasured)
}

fn has_stopped() -> bool {
    // SAFETY: written only by `NonMaskableInt`, which never returns; every bit pattern is a number.
    #[allow(unsafe_code)]
    unsafe {
        (&raw const STOPPED).read_volatile().assume_init() == HAS_STOPPED
    }
}

/// The crystal has stopped: the hardware has put the core on its internal oscillator, and everything that counts time is
/// wrong. Start anew, on that oscillator until power goes: a crystal that comes and goes would cost every start 34 s.
#[exception]
#[allow(unsafe_code)]
// SAFETY: an exception that may come anywhere must be unsafe; this one returns to nobody.
unsafe fn NonMaskableInt() -> ! {
    // SAFETY: nothing else runs any more.
    unsafe { (&raw mut STOPPED).write_volatile(MaybeUninit::new(HAS_STOPPED)) }
    retained_ram::leave_last_words(format_args!("{}", ClockFault::Stopped));
    super::restart()
}
