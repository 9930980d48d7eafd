//! The UART of the scalar sensor, whose bytes are counted for the lock-step.

use super::protocol::note_scalar_byte;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::serial::Rx;

/// The UART of the scalar sensor.
pub struct ScalarPort(pub Rx<pac::USART1>);

impl serial::ErrorType for ScalarPort {
    type Error = stm32f4xx_hal::serial::Error;
}

impl serial::Read<u8> for ScalarPort {
    fn read(&mut self) -> nb::Result<u8, Self::Error> {
        let byte = serial::Read::<u8>::read(&mut self.0)?;
        note_scalar_byte();
        Ok(byte)
    }
}
