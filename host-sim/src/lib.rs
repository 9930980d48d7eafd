//! The host side of towmag: recordings in, the firmware's own core in the middle, results and a page out.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(not(target_os = "none"))]
pub mod coefficients_file;
#[cfg(not(target_os = "none"))]
pub mod collect;
#[cfg(not(target_os = "none"))]
pub mod command;
#[cfg(not(target_os = "none"))]
mod compensated_csv;
#[cfg(not(target_os = "none"))]
pub mod detection;
#[cfg(not(target_os = "none"))]
pub mod diagnosis;
#[cfg(not(target_os = "none"))]
pub mod effects;
#[cfg(all(not(target_os = "none"), unix))]
pub mod emulator;
#[cfg(not(target_os = "none"))]
pub mod error;
#[cfg(not(target_os = "none"))]
pub mod listen;
#[cfg(not(target_os = "none"))]
mod message;
#[cfg(not(target_os = "none"))]
pub mod output;
#[cfg(not(target_os = "none"))]
mod pace;
#[cfg(not(target_os = "none"))]
mod progress;
#[cfg(not(target_os = "none"))]
pub mod provenance;
#[cfg(not(target_os = "none"))]
pub mod recording;
#[cfg(not(target_os = "none"))]
pub mod report;
#[cfg(not(target_os = "none"))]
pub mod run;
#[cfg(not(target_os = "none"))]
pub mod simulator;
#[cfg(not(target_os = "none"))]
pub mod summary;
#[cfg(not(target_os = "none"))]
pub mod text;
#[cfg(not(target_os = "none"))]
pub mod wire;

#[cfg(not(target_os = "none"))]
pub use progress::show_no_progress;
