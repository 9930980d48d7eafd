//! The pins of the three lights.

use stm32f4xx_hal::gpio::{ErasedPin, Output, PinState};
use towmag::hardware::LightOutput;
use towmag::lights::Lights;

/// Lights that are on when their pin is high.
pub struct LightPins {
    pub green: ErasedPin<Output>,
    pub yellow: ErasedPin<Output>,
    pub red: ErasedPin<Output>,
}

impl LightOutput for LightPins {
    fn show(&mut self, lights: Lights) {
        self.green.set_state(PinState::from(lights.green));
        self.yellow.set_state(PinState::from(lights.yellow));
        self.red.set_state(PinState::from(lights.red));
    }
}
