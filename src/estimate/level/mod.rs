//! The level of the compensated field: what the 18 terms make of a heading, not only of the motion on it.
//!
//! The adaptive bank knows what the band shows, and its output follows changes alone. Here a second estimator learns the
//! same terms from rows that the slow background is whitened out of, with nothing that pulls its coefficients to zero, and
//! the output's level is its: `docs/adaptive.md`, "The level", has the measurements behind every choice.

mod columns;
mod config;
mod estimator;
mod gauge;
mod output;
mod whitening;

pub use columns::LEVEL_COLUMNS;
pub use config::Level;
pub use estimator::LevelEstimator;
pub use output::{LevelOutput, Written};
