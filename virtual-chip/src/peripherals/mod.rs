//! The chip's peripherals, as far as the firmware uses them.

pub mod adc;
mod addresses;
pub mod bus;
mod clocking;
pub mod complaint;
pub mod core;
pub mod exti;
pub mod flash;
pub mod gpio;
pub mod nvic;
pub mod pwr;
pub mod rcc;
pub mod spi;
pub mod timer;
pub mod usart;
pub mod watchdog;
mod wiring;
