//! The UART of the tow cable.

use crate::status::Count;
use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Read as _, Write as _};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::serial::{Rx, RxListen, Tx, TxListen};

/// Bytes taken in one call.
const LONGEST_BURST: usize = 16;

/// To the ship.
pub struct CableTx {
    tx: Tx<pac::USART2>,
    waiting: Option<u8>,
}

impl CableTx {
    pub fn new(tx: Tx<pac::USART2>) -> Self {
        Self { tx, waiting: None }
    }

    /// Have the `cable` task run: there is something to send.
    pub fn wake(&mut self) {
        self.tx.listen();
        // An emulated UART is never busy and raises no interrupt when it is free.
        rtic::pend(pac::Interrupt::USART2);
    }

    /// Send until the UART is busy or nothing is left; only in the first case it calls again.
    pub fn send(&mut self, mut next: impl FnMut() -> Option<u8>) {
        while let Some(byte) = self.waiting.take().or_else(&mut next) {
            if let Err(nb::Error::WouldBlock) = self.tx.write(byte) {
                self.waiting = Some(byte);
                return self.tx.listen();
            }
        }
        self.tx.unlisten();
    }
}

/// From the ship.
pub struct CableRx {
    rx: Rx<pac::USART2>,
}

impl CableRx {
    pub fn new(mut rx: Rx<pac::USART2>) -> Self {
        rx.listen();
        Self { rx }
    }

    /// Give on what has come, `None` for an error.
    pub fn drain(&mut self, mut give: impl FnMut(Option<u8>)) {
        for _ in 0..LONGEST_BURST {
            match self.rx.read() {
                Ok(byte) => give(Some(byte)),
                Err(nb::Error::WouldBlock) => break,
                Err(nb::Error::Other(_)) => {
                    Count::CableOverruns.add(1);
                    give(None);
                }
            }
        }
    }
}
