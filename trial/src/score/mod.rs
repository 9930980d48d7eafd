//! What was said against what was hidden.

mod calibration;
mod confusion;
mod drivers;
mod figure;
mod judged;
mod names;
mod on;
mod parameters;
mod rate;
mod several;
mod shrink;
mod singles;
mod targets;
mod total;
mod withheld;

#[cfg(test)]
mod tests;

pub use calibration::{Calibration, Promise};
pub use drivers::DriverScore;
pub use figure::{Figure, State, figures, on_figures};
pub(crate) use on::on_score;
pub use on::{OnBin, OnScore};
pub use rate::Rate;
pub use several::Several;
pub use shrink::Shrink;
pub use singles::Bin;
pub use targets::TargetScore;
pub use total::Score;
pub(crate) use total::score;
pub use withheld::WithheldScore;
