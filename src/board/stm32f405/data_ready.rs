//! The pin that the converter pulls down when a conversion is ready.

use super::system::System;
use stm32f4xx_hal::gpio::{self, Edge, ExtiPin, Input};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use towmag::hardware::{self, Stamp, System as _};

/// The data-ready pin.
pub struct DataReady(gpio::PC6<Input>);

impl DataReady {
    pub fn new(pin: gpio::PC6, syscfg: pac::SYSCFG, mut exti: pac::EXTI, rcc: &mut Rcc) -> Self {
        let mut pin = pin.into_pull_up_input();
        pin.make_interrupt_source(&mut syscfg.constrain(rcc));
        pin.trigger_on_edge(&mut exti, Edge::Falling);
        pin.enable_interrupt(&mut exti);
        Self(pin)
    }
}

impl hardware::DataReady for DataReady {
    fn take(&mut self) -> Option<u32> {
        let now_us = System::new().stamp_us(Stamp::Conversion);
        let is_ready = self.0.check_interrupt();
        self.0.clear_interrupt_pending_bit();
        is_ready.then_some(now_us)
    }
}
