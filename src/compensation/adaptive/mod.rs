//! The adaptive method: a bank of square-root estimators that differ in how much of the calibration they keep, averaged
//! by how well each has predicted. The mathematics, the choice of every constant and what can go wrong are in
//! `docs/adaptive.md`.

mod bank;
mod member;
mod quality;
mod tuning;

pub use bank::Bank;
pub use quality::{Adaptation, Quality};
pub use tuning::Adaptive;

/// Members of the bank: four that start at the calibration, one that starts at zero.
pub const MEMBERS: usize = 5;

/// Share of the calibration's information that each member keeps. The last two keep none, and start anew in turn.
const SHARES: [f32; MEMBERS] = [1.0, 0.1, 0.01, 0.0, 0.0];

/// The first of the members that hold nothing of the calibration.
const FIRST_FREE: usize = 3;
