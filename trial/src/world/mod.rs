//! The trial's own world, from the definitions of the effects alone and not from the simulator that the diagnosis fits:
//! what the trial says is then no praise of a program by itself.
//!
//! ```text
//! motion -> direction -> 18 terms + Earth's field = clean scalar, at 100 Hz
//!   + targets, in the Earth's field                                 (target)
//!   + what each hidden effect changes, each on the clean signals    (effects, foreign)
//!   + noise -> repeats, rounding -> the recorder's own rounding -> holes -> CSV
//! ```

mod body;
mod columns;
pub(crate) mod drivers;
mod earth;
pub(crate) mod effects;
pub(crate) mod foreign;
mod grid;
mod motion;
mod noise;
mod readings;
mod recorded;
mod rounding;
mod simulated;
mod state;
pub(crate) mod target;
mod tones;
pub(crate) mod vector;
mod written;

#[cfg(test)]
mod tests;

pub(crate) use body::columns as terms;
pub(crate) use noise::{BAND_HZ, Noise};
pub(crate) use readings::{Change, Last, Readings, magnitudes};
pub(crate) use rounding::Recorder;
pub(crate) use simulated::simulation;
pub(crate) use state::World;
pub(crate) use written::csv;
