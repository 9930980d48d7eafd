//! An SD card in SPI mode, byte by byte, and the bus that it is on, in virtual time.
//!
//! From the SD Physical Layer Simplified Specification, chapter 7. What is simplified: commands that the body does not use
//! are answered as illegal, and the registers hold nothing but what the driver looks at.

mod answers;
mod card;
mod commands;
mod faults;
mod size;
mod wire;
mod world;

pub use card::{Capacity, SdCard};
pub use faults::Fault;
pub use wire::{VirtualBus, VirtualDelay, VirtualSelect};
pub use world::World;
