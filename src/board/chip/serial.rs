//! The UARTs of the sensors and of the tow cable.

use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{self, Write};
use stm32f4xx_hal::gpio::alt::SerialAsync;
use stm32f4xx_hal::gpio::{self, PushPull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::serial::{Config, Rx, RxListen, Serial, Tx, TxListen};
use towmag::hardware::{self, SensorPort};

/// The pins that transmit for a UART.
type TxPin<U> = <U as SerialAsync>::Tx<PushPull>;

/// The pins that receive for a UART.
type RxPin<U> = <U as SerialAsync>::Rx<PushPull>;

/// Receiver of the scalar sensor, and the transmitter, which is for the self-test.
pub fn scalar(
    uart: pac::USART1,
    pins: (impl Into<TxPin<pac::USART1>>, impl Into<RxPin<pac::USART1>>),
    baud: u32,
    rcc: &mut Rcc,
) -> (Tx<pac::USART1>, Rx<pac::USART1>) {
    let config = Config::default().baudrate(baud.bps());
    let serial: Serial<pac::USART1> = Serial::new(uart, pins, config, rcc).expect("the baud rate fits");
    let (transmitter, mut receiver) = serial.split();
    receiver.listen();
    (transmitter, receiver)
}

/// Receiver of the depth sensor, altimeter or GPS receiver. Nothing need be connected: then its pin is pulled up.
pub fn nmea(
    uart: pac::USART3,
    (tx, rx): (gpio::PB10, gpio::PB11),
    baud: u32,
    rcc: &mut Rcc,
) -> (Tx<pac::USART3>, Rx<pac::USART3>) {
    let config = Config::default().baudrate(baud.bps());
    let rx = rx.into_alternate().internal_pull_up(true);
    let serial: Serial<pac::USART3> = Serial::new(uart, (tx, rx), config, rcc).expect("the baud rate fits");
    let (transmitter, mut receiver) = serial.split();
    receiver.listen();
    (transmitter, receiver)
}

/// Both ends of the tow cable.
pub fn cable(
    uart: pac::USART2,
    pins: (impl Into<TxPin<pac::USART2>>, impl Into<RxPin<pac::USART2>>),
    baud: u32,
    rcc: &mut Rcc,
) -> (CableTransmitter, Rx<pac::USART2>) {
    let config = Config::default().baudrate(baud.bps());
    let serial: Serial<pac::USART2> = Serial::new(uart, pins, config, rcc).expect("the baud rate fits");
    let (transmitter, mut receiver) = serial.split();
    receiver.listen();
    (CableTransmitter(transmitter), receiver)
}

/// Out of the sensors' UARTs.
pub struct SensorTransmitters {
    pub scalar: Tx<pac::USART1>,
    pub nmea: Tx<pac::USART3>,
}

impl hardware::SensorTransmitters for SensorTransmitters {
    fn send(&mut self, port: SensorPort, byte: u8) {
        // Busy: what was sent before is what comes back.
        _ = match port {
            SensorPort::Scalar => Write::<u8>::write(&mut self.scalar, byte),
            SensorPort::Nmea => Write::<u8>::write(&mut self.nmea, byte),
        };
    }
}

/// To the ship.
pub struct CableTransmitter(Tx<pac::USART2>);

impl serial::ErrorType for CableTransmitter {
    type Error = <Tx<pac::USART2> as serial::ErrorType>::Error;
}

impl Write<u8> for CableTransmitter {
    fn write(&mut self, byte: u8) -> nb::Result<(), Self::Error> {
        Write::<u8>::write(&mut self.0, byte)
    }

    fn flush(&mut self) -> nb::Result<(), Self::Error> {
        Write::<u8>::flush(&mut self.0)
    }
}

impl hardware::CableTransmitter for CableTransmitter {
    fn listen(&mut self) {
        self.0.listen();
    }

    fn unlisten(&mut self) {
        self.0.unlisten();
    }

    fn wake(&mut self) {
        self.0.listen();
        // An emulated UART is never busy and raises no interrupt when it is free.
        rtic::pend(pac::Interrupt::USART2);
    }
}
