//! A model of the ADS131M04 as seen from its SPI pins: enough for the driver's set-up, conversions and faults.

use std::convert::Infallible;

use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use towmag::sensors::ads131m04::FRAME_BYTES;

use super::feed::Step;

const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

const MODE: usize = 2;
const MODE_AT_RESET: u16 = 0x0510;
const RX_CRC_ENABLED: u16 = 0x1000;
const RESET_FLAG: u16 = 0x0400;
const ID: u16 = 0x2405;

/// The converter.
pub(crate) struct Adc {
    registers: [u16; 64],
    response: Response,
    is_ready: bool,
    command_crc_failed: bool,
}

/// What the next frame answers.
#[derive(Clone, Copy)]
enum Response {
    Status,
    Word(u16),
}

impl Adc {
    /// As after power-up.
    pub(crate) fn new() -> Self {
        let mut registers = [0; 64];
        registers[0] = ID;
        registers[MODE] = MODE_AT_RESET;
        Self { registers, response: Response::Status, is_ready: false, command_crc_failed: false }
    }

    /// A conversion has ended.
    pub(crate) fn convert(&mut self) {
        self.is_ready = true;
    }

    /// One frame: the command in, the answer to the last one and the conversion out.
    pub(crate) fn exchange(&mut self, command: &[u8; FRAME_BYTES], counts: [i32; 4]) -> [u8; FRAME_BYTES] {
        let mut answer = [0; FRAME_BYTES];
        let word = match self.response {
            Response::Status => self.status(),
            Response::Word(word) => word,
        };
        answer[..2].copy_from_slice(&word.to_be_bytes());
        for (place, count) in answer[3..15].chunks_exact_mut(3).zip(counts) {
            place.copy_from_slice(&count.to_be_bytes()[1..]);
        }
        let crc = CRC.checksum(&answer[..15]);
        answer[15..17].copy_from_slice(&crc.to_be_bytes());
        self.is_ready = false;
        self.response = self.obey(command);
        answer
    }

    fn status(&mut self) -> u16 {
        let ready = if self.is_ready { 0x000F } else { 0 };
        let reset = self.registers[MODE] & RESET_FLAG;
        let crc = if std::mem::take(&mut self.command_crc_failed) { 0x1000 } else { 0 };
        crc | reset | 0x0100 | ready
    }

    fn obey(&mut self, bytes: &[u8; FRAME_BYTES]) -> Response {
        let word = |at: usize| u16::from_be_bytes([bytes[at], bytes[at + 1]]);
        let command = word(0);
        let writes = command & 0xE000 == 0x6000;
        let covered = if writes { 6 } else { 3 };
        if self.registers[MODE] & RX_CRC_ENABLED != 0 && CRC.checksum(&bytes[..covered]) != word(covered) {
            self.command_crc_failed = true;
            return Response::Status;
        }
        let register = usize::from(command >> 7 & 0x3F);
        match command {
            0x0011 => {
                *self = Self::new();
                Response::Word(0xFF24)
            }
            _ if writes => {
                self.registers[register] = word(3);
                Response::Word(command & 0x1FFF | 0x4000)
            }
            _ if command & 0xE000 == 0xA000 => Response::Word(self.registers[register]),
            _ => Response::Status,
        }
    }
}

/// A bus with the converter on it.
pub(crate) struct AdcBus {
    adc: Adc,
    counts: [i32; 4],
    unplugged: bool,
    damaged: bool,
}

impl Default for AdcBus {
    fn default() -> Self {
        Self { adc: Adc::new(), counts: [0; 4], unplugged: false, damaged: false }
    }
}

impl AdcBus {
    /// A conversion has ended.
    pub(crate) fn convert(&mut self, step: &Step) {
        (self.counts, self.unplugged, self.damaged) = (step.counts, step.unplugged, step.damaged_frame);
        self.adc.convert();
    }
}

impl ErrorType for AdcBus {
    type Error = Infallible;
}

impl SpiDevice for AdcBus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else { continue };
            let Some(command) = bytes.first_chunk() else { continue };
            let mut frame = self.adc.exchange(command, self.counts);
            if self.unplugged {
                (self.adc, frame) = (Adc::new(), [0; FRAME_BYTES]);
            }
            if std::mem::take(&mut self.damaged) {
                damage(&mut frame);
            }
            bytes.copy_from_slice(&frame);
        }
        Ok(())
    }
}

/// A bit is another on the way.
pub(crate) fn damage(frame: &mut [u8; FRAME_BYTES]) {
    frame[7] ^= 0x10;
}

#[cfg(test)]
mod tests {
    use super::*;
    use towmag::body::Converter;

    struct NoDelay;

    impl embedded_hal::delay::DelayNs for NoDelay {
        fn delay_ns(&mut self, _: u32) {}
    }

    #[test]
    fn the_driver_accepts_the_model() {
        let mut converter = Converter::new(AdcBus::default());
        assert!(converter.set_up(0, &mut NoDelay));
        let step = Step { counts: [1, -2, 8_388_607, -8_388_608], ..Step::default() };
        converter.bus_mut().convert(&step);
        let conversion = converter.fetch(7, &mut NoDelay).unwrap();
        assert_eq!((conversion.counts, conversion.ready_us), ([1, -2, 8_388_607, -8_388_608], 7));
    }
}
