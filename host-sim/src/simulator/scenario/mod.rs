//! A scenario: the TOML file that `host-sim simulate` makes a recording from. Every key is in `docs/scenarios.md`.

mod body;
mod check;
mod earth;
mod field;
mod file;
mod motion;
mod noise;
mod path;
mod rows;
mod sensed;
mod simulation;
mod table;
mod waves;

#[cfg(test)]
mod tests;

pub use body::{Colour, Current, FlaggedZone, InterferenceSource, Sensor, Temperature};
pub use field::{Background, Field};
pub use file::Scenario;
pub use motion::{Motion, Tow, WaveSpectrum};
pub use rows::{Columns, Interval, TargetSpec};
pub use sensed::Lost;
pub(crate) use simulation::band_passed_std_nt;
pub use simulation::{Recorded, Simulation};
