//! The pins of the three lights.

use stm32f4xx_hal::gpio::{Output, PC0, PC1, PC2, PinState};
use towmag::hardware::LightOutput;
use towmag::lights::Lights;

/// Lights that are on when their pin is high.
pub struct LightPins {
    green: PC0<Output>,
    yellow: PC1<Output>,
    red: PC2<Output>,
}

impl LightPins {
    pub fn new((green, yellow, red): (PC0, PC1, PC2)) -> Self {
        Self {
            green: green.into_push_pull_output(),
            yellow: yellow.into_push_pull_output(),
            red: red.into_push_pull_output(),
        }
    }
}

impl LightOutput for LightPins {
    fn show(&mut self, lights: Lights) {
        self.green.set_state(PinState::from(lights.green));
        self.yellow.set_state(PinState::from(lights.yellow));
        self.red.set_state(PinState::from(lights.red));
    }
}
