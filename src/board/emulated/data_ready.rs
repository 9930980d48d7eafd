//! The converter's data-ready edge: TIM5 makes as many to an epoch as the grid expects.

use super::protocol::note_conversion;
use super::system::System;
use crate::board::chip::timers::now_us;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use embedded_hal::delay::DelayNs;
use stm32f4xx_hal::pac::{self, interrupt};
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use towmag::hardware::{self, SpinDelay, Stamp, System as _};
use towmag::sensors::grid::EPOCH_US;

/// That of the fluxgate's task, which the edge stands for.
const PRIORITY: u8 = 4;

static IS_READY: AtomicBool = AtomicBool::new(false);

/// The data-ready edge.
pub struct DataReady;

impl DataReady {
    /// Start the timer, whose clock runs at `timer_mhz`, and let its interrupt through: RTIC knows nothing of it.
    pub fn start(timer: pac::TIM5, rcc: &mut Rcc, timer_mhz: u16, conversions_per_epoch: u8) -> Self {
        let per_epoch = u32::from(conversions_per_epoch).max(1);
        pac::TIM5::enable(rcc);
        pac::TIM5::reset(rcc);
        timer.psc().write(|w| w.psc().set(timer_mhz - 1));
        timer.arr().write(|w| w.arr().set(EPOCH_US / per_epoch - 1));
        timer.egr().write(|w| w.ug().set_bit());
        timer.cnt().write(|w| w.cnt().set(now_us()));
        timer.sr().write(|w| w.uif().clear_bit());
        timer.dier().write(|w| w.uie().set_bit());
        timer.cr1().write(|w| w.cen().set_bit());
        // Keeps the edges off the instants at which `assemble` runs, whose stamps would else come out of order.
        SpinDelay(&System::new()).delay_ms(13);
        // An edge during the wait has come too early for anyone to see.
        IS_READY.store(false, Relaxed);
        let priority = rtic::export::cortex_logical2hw(PRIORITY, pac::NVIC_PRIO_BITS);
        // SAFETY: nothing else touches this interrupt; interrupts are off until every task is ready for them.
        #[allow(unsafe_code)]
        unsafe {
            cortex_m::Peripherals::steal().NVIC.set_priority(pac::Interrupt::TIM5, priority);
            cortex_m::peripheral::NVIC::unmask(pac::Interrupt::TIM5);
        }
        Self
    }
}

impl hardware::DataReady for DataReady {
    fn take(&mut self) -> Option<u32> {
        IS_READY.swap(false, Relaxed).then(|| System::new().stamp_us(Stamp::Conversion))
    }
}

/// The edge: pend the interrupt that the pin would.
#[interrupt]
fn TIM5() {
    // SAFETY: clears the interrupt flag of a timer that nothing else touches once it runs.
    #[allow(unsafe_code)]
    let timer = unsafe { &*pac::TIM5::ptr() };
    timer.sr().write(|w| w.uif().clear_bit());
    note_conversion();
    IS_READY.store(true, Relaxed);
    System::new().wake_fluxgate();
}
