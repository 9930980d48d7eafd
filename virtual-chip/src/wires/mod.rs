//! What is at the other end of the chip's wires.

pub mod converter;
pub mod serial;
pub mod pulses;
