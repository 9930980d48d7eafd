//! A scenario: the TOML file that `host-sim simulate` makes a recording from. Every key is in `docs/scenarios.md`.

mod body;
mod check;
mod dipole;
mod earth;
mod field;
mod file;
mod motion;
mod navigation;
mod noise;
mod path;
mod place;
mod rows;
mod sensed;
mod simulation;
mod table;
mod waves;

#[cfg(test)]
mod tests;

pub use body::{Colour, Current, FlaggedZone, InterferenceSource, Sensor, Temperature};
pub use dipole::{DipoleSpec, Moment};
pub use field::{Background, Bottom, Field};
pub use file::Scenario;
pub use motion::{Motion, Tow, WaveSpectrum};
pub use place::{Dipole, Track};
pub use rows::{Columns, Interval, Ship, TargetSpec};
pub use sensed::Lost;
pub(crate) use simulation::band_passed_std_nt;
pub use simulation::{Recorded, Simulation};
