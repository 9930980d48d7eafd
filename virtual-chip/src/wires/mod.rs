//! What is at the other end of the chip's wires.

pub mod converter;
pub mod pulses;
pub mod serial;
