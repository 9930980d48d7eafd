//! What was said against what was hidden.

mod calibration;
mod confusion;
mod figure;
mod judged;
mod on;
mod pairs;
mod parameters;
mod rate;
mod shrink;
mod singles;
mod total;
mod withheld;

pub use calibration::{Calibration, Promise};
pub use figure::{Figure, State, figures, on_figure};
pub(crate) use on::on_score;
pub use on::{OnBin, OnScore};
pub use pairs::PairBin;
pub use rate::Rate;
pub use shrink::Shrink;
pub use singles::Bin;
pub use total::Score;
pub(crate) use total::score;
pub use withheld::WithheldScore;
