//! The pulse per second of a GPS receiver: captured by the free-running timer itself, to the microsecond.

use stm32f4xx_hal::gpio::{Alternate, PA0};
use stm32f4xx_hal::pac;
use towmag::hardware;

/// Channel 1 of TIM2, on PA0.
pub struct SecondPulses(());

impl SecondPulses {
    /// Capture rising edges; noise shorter than eight periods of the timer's clock is none (reference manual RM0090,
    /// 18.4.7). The pin is pulled down, so that an open one is quiet.
    pub fn start(pin: PA0) -> Self {
        let _: PA0<Alternate<1>> = pin.internal_pull_down(true).into_alternate();
        // SAFETY: channel 1 is nobody else's; the counter is left alone.
        #[allow(unsafe_code)]
        let timer = unsafe { &*pac::TIM2::ptr() };
        #[allow(unsafe_code)]
        timer.ccmr1_input().modify(|_, w| unsafe { w.cc1s().bits(0b01).ic1f().bits(0b0011) });
        timer.ccer().modify(|_, w| w.cc1e().set_bit());
        Self(())
    }
}

impl hardware::SecondPulses for SecondPulses {
    fn take(&mut self) -> Option<u32> {
        // SAFETY: reads the flag and the capture of channel 1, which are nobody else's.
        #[allow(unsafe_code)]
        let timer = unsafe { &*pac::TIM2::ptr() };
        // Reading the capture clears the flag.
        timer.sr().read().cc1if().bit_is_set().then(|| timer.ccr1().read().bits())
    }
}
