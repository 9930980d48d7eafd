//! The SPI device of the fluxgate's converter: every transaction is the host's, and in lock-step with it.

use super::cost::Wait;
use super::host::{self, File};
use super::protocol::{self, Order, answers, has_sensor_bytes, receive_answer, requests, send_request};
use super::system::restart;
use crate::board::chip::timers::now_us;
use embedded_hal::spi::{self, ErrorKind, Operation, SpiDevice};
use towmag::sensors::ads131m04::FRAME_BYTES;

/// The SPI device of the converter.
pub struct FluxgateBus {
    requests: File,
    answers: File,
}

impl FluxgateBus {
    pub fn open() -> Self {
        protocol::note_boot(now_us());
        Self { requests: requests(), answers: answers() }
    }

    fn exchange(&mut self, frame: &mut [u8; FRAME_BYTES]) {
        let wait = Wait::begin();
        send_request(&self.requests, frame);
        let answer = receive_answer(&self.answers);
        *frame = answer.frame;
        // The bytes are on their way.
        while !has_sensor_bytes(answer.sensor_bytes) {
            host::pass_time();
        }
        wait.end();
        obey(answer.order);
    }
}

/// Do what the host wants.
fn obey(order: Order) {
    match order {
        Order::GoOn => {}
        Order::Restart => restart(),
        Order::Panic => panic!("the emulator's host asked for a panic"),
        Order::Exit => host::exit(),
    }
}

impl spi::ErrorType for FluxgateBus {
    type Error = ErrorKind;
}

impl SpiDevice for FluxgateBus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let [Operation::TransferInPlace(bytes)] = operations else { return Err(ErrorKind::Other) };
        let frame = bytes.first_chunk_mut().ok_or(ErrorKind::Other)?;
        self.exchange(frame);
        Ok(())
    }
}
