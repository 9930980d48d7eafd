//! What a method does to what a survey is for: known anomalies are added to a recording, and every method runs twice, with
//! and without them. An estimator fits whatever comes in the band; a small residual alone may mean that it fits the
//! targets away.

mod bound;
mod combination;
mod figures;
mod injection;
mod pulse;
mod standard;
mod targets;

pub use combination::{Combination, SETS, combination};
pub use figures::Detection;
pub use injection::{InjectionSettings, detection_of_injected};
pub use pulse::{BandPulse, band_pulse};
pub use standard::standard_targets;
pub use targets::injected_targets;
