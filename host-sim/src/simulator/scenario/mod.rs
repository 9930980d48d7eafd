//! A scenario: the TOML file that `host-sim simulate` makes a recording from. Every key is in `docs/scenarios.md`.

mod body;
mod check;
mod check_survey;
mod coefficients;
mod dipole;
mod earth;
mod field;
mod file;
mod motion;
mod navigation;
mod noise;
mod path;
mod place;
mod range;
mod rows;
mod second;
mod sensed;
mod simulation;
mod table;
mod wake;
mod waves;

#[cfg(test)]
mod tests;

pub use body::{Colour, Current, FlaggedZone, InterferenceSource, SecondScalar, Sensor, Temperature};
pub(crate) use coefficients::band_passed_std_nt;
pub use dipole::{DipoleSpec, Moment};
pub use field::{Background, Bottom, Field};
pub use file::Scenario;
pub use motion::{Motion, Tow, WaveSpectrum};
pub use place::{Dipole, Track};
pub use rows::{Columns, Interval, Ship, TargetSpec};
pub use sensed::Lost;
pub use simulation::{Recorded, Simulation};
