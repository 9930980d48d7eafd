//! An STM32F405 in memory that runs the board's own image, and what is soldered to it.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]

pub mod blocks;
pub mod board;
pub mod chip;
pub mod clocks;
mod cpu;
pub mod image;
pub mod lines;
pub mod machine;
pub mod peripherals;
pub mod time;
pub mod wires;
