//! What is soldered around the chip.

use crate::wires::converter::Converter;
use crate::wires::serial::Line;
use towmag_virtual_body::sd::SdCard;

/// The oscillators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillators {
    /// The crystal; `None` when it does not swing.
    pub crystal_hz: Option<f64>,
    /// The internal oscillator, nominally 16 MHz.
    pub internal_hz: f64,
    /// The low-speed oscillator, 17 to 47 kHz.
    pub low_speed_hz: f64,
}

impl Default for Oscillators {
    fn default() -> Self {
        Self { crystal_hz: Some(8e6), internal_hz: 16e6, low_speed_hz: 32e3 }
    }
}

/// What the chip is wired to, and fed with.
pub struct Board {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// The supply, millivolts.
    pub supply_mv: u32,
    /// The fluxgate's converter, if it is there.
    pub converter: Option<Converter>,
    /// The card in its socket.
    pub card: Option<SdCard>,
    /// The wires into USART1 (scalar sensor), USART2 (ship) and USART3 (depth, altitude, position).
    pub lines: [Line; 3],
}

impl Default for Board {
    /// A crystal, 3.3 V, and nothing else: the wires are quiet.
    fn default() -> Self {
        let lines = [9_600.0, 115_200.0, 4_800.0].map(Line::new);
        Self { oscillators: Oscillators::default(), supply_mv: 3_300, converter: None, card: None, lines }
    }
}
