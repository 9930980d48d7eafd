//! An STM32F405 in memory that runs the board's own image, byte for byte what is flashed, and what is soldered to it.
//!
//! The processor is Unicorn's: QEMU's Cortex-M4F without QEMU's devices. Everything around it is here, in virtual time:
//!
//! | module | |
//! |---|---|
//! | `image`, `lines`, `blocks` | the image, its lines, and which of its code has run |
//! | `cpu` | the engine, and the exceptions, of which it knows nothing |
//! | `machine` | what the processor meets while it runs: time, registers, reasons to stop |
//! | `peripherals` | a file for each, from the reference manual RM0090, as far as the firmware uses it |
//! | `wires`, `board` | the converter, the card, who talks on the UARTs, the oscillators, the supply |
//! | `chip` | all of it, from power-up to power-down |
//!
//! An instruction takes a cycle of the core's clock. Nothing is counted within a block of code that runs without a branch, so
//! that an interrupt comes up to a block late. A program that waits for a byte of SPI, for the end of a timer's pulse or in
//! `wfi`, and one that jumps to itself, is taken to the next thing that happens at once.
//!
//! What is modelled: oscillators, PLL and bus clocks with their limits; the clock security system; the brown-out level as an option,
//! and the supply's detector; the watchdog; programming and erasing the settings' sectors, for which the processor waits;
//! interrupts with their priorities; pins and their alternate functions; the three UARTs with rates, overruns and framing errors; both SPI
//! controllers with clock and mode; timers with captures; a converter that answers by its data sheet; the card of
//! `towmag-virtual-body`; resets and what outlives them. A register that is not known, a peripheral that is used without its
//! clock, and a clock beyond its limits end the run with the line of the source.
//!
//! What is not: the time of single instructions, of flash and caches, and what a cache holds that it should not; the
//! floating-point unit before it is switched on, and its state being put away late; faults other than accesses to nothing and undefined
//! instructions, whose place is told to the block; the debugger and its channel; levels, edges and noise on the wires;
//! the brown-out reset itself. The models were written by those who wrote the firmware: what both have misunderstood in a
//! manual, only a board can show.
//!
//! Three things about Unicorn 2.0.1 that its users must know are told in `cpu`: where it may be stopped, how a fault is
//! told, and what makes it look at its registers anew.
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
