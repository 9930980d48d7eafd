//! The adaptive method: a bank of square-root estimators that differ in how much of the calibration they keep, averaged
//! by how well each has predicted. The mathematics, the choice of every constant and what can go wrong are in
//! `docs/adaptive.md`; the constants themselves in `policy.rs`.

mod bank;
mod config;
mod member;
mod mixture;
mod quality;
mod reinitialisation;

pub use bank::Bank;
pub use config::Adaptive;
pub use quality::{Adaptation, Quality};
