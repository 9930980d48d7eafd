//! Adaptive magnetic compensation for a towed-body magnetometer.
//!
//! This crate is what runs the same on the body's microcontroller, on the desk and in the tests. It sees the
//! world only through [`Epoch`], one 10 Hz tick of sensor readings, and answers with an [`Output`]:
//!
//! ```text
//! sensor bytes -> Epoch -> Pipeline::step -> Output -> log and telemetry
//!                            |
//!                            +- FrontEnd   18 Tolles-Lawson terms, gaps, band-pass 0.1 to 0.9 Hz
//!                            +- Estimator  fixed | rls | saddle-point | adaptive, on square-root information factors
//! ```
//!
//! No clock, no I/O, no allocation, no panic; `f32` arithmetic in a fixed order and `libm` alone, so that the same
//! epochs give the same bits on every machine.
#![no_std]
#![forbid(unsafe_code)]

pub mod acquire;
pub mod assemble;
pub mod body;
mod bytes;
pub mod compensate;
pub mod connect;
pub mod console;
mod epoch;
mod epoch_producer;
pub mod estimate;
pub mod filter;
pub mod fluxgate_calibration;
mod front_end;
pub mod hardware;
pub mod health;
pub mod housekeeping;
pub mod lights;
pub mod link;
pub mod log;
pub mod microcontroller;
pub mod model;
pub mod navigation;
mod pipeline;
mod policy;
pub mod queues;
mod running;
pub mod sd_card;
pub mod self_test;
pub mod sensors;
mod settings;
pub mod storage;
pub mod store;
pub mod telemetry;
mod wire;

pub use epoch::{Compensated, EPOCH_S, EPOCH_US, Epoch, Output, RATE_HZ, Rejection, Status};
pub use front_end::{FrontEnd, FrontEndState, Observation};
pub use pipeline::Pipeline;
pub use settings::{Method, Settings, SettingsError};
