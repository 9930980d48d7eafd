//! The UART of the depth sensor, whose bytes are counted for the lock-step.

use super::protocol::count_sensor_byte;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::serial::Rx;

/// The UART of the depth sensor.
pub struct NmeaPort(pub Rx<pac::USART3>);

impl serial::ErrorType for NmeaPort {
    type Error = stm32f4xx_hal::serial::Error;
}

impl serial::Read<u8> for NmeaPort {
    fn read(&mut self) -> nb::Result<u8, Self::Error> {
        let byte = serial::Read::<u8>::read(&mut self.0)?;
        count_sensor_byte();
        Ok(byte)
    }
}
