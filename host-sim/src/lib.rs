//! The host side of towmag: recordings in, the firmware's own core in the middle, results and a page out.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(not(target_os = "none"))]
pub mod simulator;
