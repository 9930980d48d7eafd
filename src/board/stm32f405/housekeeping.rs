//! The leak contact on PC3, and the battery's divider on channel 14 of the first converter, PC4.
//!
//! By the converter's registers: the HAL's start measures the chip's own reference, waits for it and divides by it. A body
//! whose converter is broken must start all the same.

use stm32f4xx_hal::gpio::{Analog, Input, PC3, PC4};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use towmag::hardware;
use towmag::housekeeping::HousekeepingSample;

/// PC4, by the number that the converter has for it.
const CHANNEL: u8 = 14;

/// Leak contact and divider.
pub struct HousekeepingInputs {
    contact: PC3<Input>,
    converter: pac::ADC1,
}

impl HousekeepingInputs {
    /// The contact closes to ground when it is wet, and is pulled up inside: an open one is dry. The converter takes 492
    /// periods of 10.5 MHz, 47 us, for a conversion, and starts with the first sample.
    pub fn start(contact: PC3, divider: PC4, converter: pac::ADC1, common: &pac::ADC_COMMON, rcc: &mut Rcc) -> Self {
        let _: PC4<Analog> = divider.into_analog();
        pac::ADC1::enable(rcc);
        pac::ADC1::reset(rcc);
        common.ccr().modify(|_, w| w.adcpre().div8());
        converter.smpr1().modify(|_, w| w.smp14().cycles480());
        // SAFETY: the field takes every channel that there is.
        #[allow(unsafe_code)]
        converter.sqr3().modify(|_, w| unsafe { w.sq1().bits(CHANNEL) });
        converter.cr2().modify(|_, w| w.adon().set_bit());
        Self { contact: contact.into_pull_up_input(), converter }
    }
}

impl hardware::HousekeepingInputs for HousekeepingInputs {
    /// What was converted since the last call, and the start of the next conversion.
    fn sample(&mut self) -> HousekeepingSample {
        let is_done = self.converter.sr().read().eoc().bit_is_set();
        // Reading it clears the flag.
        let battery_counts = is_done.then(|| self.converter.dr().read().data().bits());
        self.converter.cr2().modify(|_, w| w.swstart().set_bit());
        HousekeepingSample { is_wet: self.contact.is_low(), battery_counts }
    }
}
