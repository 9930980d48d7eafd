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

/// Members of the bank: four that start at the calibration, one that starts at zero, and the plain one.
pub const MEMBERS: usize = 6;

/// Share of the calibration's information that each member keeps. A millionth says nothing of the values, but which
/// combinations of coefficients are barely determined.
const SHARES: [f32; MEMBERS] = [1.0, 0.1, 0.01, NEXT_TO_NOTHING, 0.0, NEXT_TO_NOTHING];

/// Cost of each member, nats of evidence: little for each step away from the calibration, much for letting it go.
const COSTS: [f32; MEMBERS] = [0.0, 1.0, 2.0, 8.0, 10.0, 13.0];

/// How many times faster each member forgets.
const HASTES: [f64; MEMBERS] = [1.0, 1.0, 1.0, 1.0, 5.0, 1.0];

/// The members that hold nothing of the calibration, and start anew in turn: one with the long memory, one with the short.
const LONG: usize = 3;
const SHORT: usize = 4;

/// The member that learns as recursive least squares does, from rows as they are and behind a wide gate: where the 18
/// terms are not enough, what they leave is no noise, and what leaves least of it in the band is the plain fit.
const PLAIN: usize = 5;

/// Share of earlier information that a free member starts with.
const NEXT_TO_NOTHING: f32 = 1e-6;
