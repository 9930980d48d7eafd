#![cfg_attr(target_os = "none", no_std)]
//! Host side.

#[cfg(not(target_os = "none"))]
pub mod report;
