//! What the host program is made of. Empty on the microcontroller, where nothing of it can run.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(not(target_os = "none"))]
mod message;
#[cfg(not(target_os = "none"))]
pub mod output;
#[cfg(not(target_os = "none"))]
pub mod recording;
