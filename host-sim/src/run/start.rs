//! Where every method starts from.

use towmag::estimate::Prior;
use towmag::model::TERMS;

/// Where every method starts from.
#[derive(Clone, Debug)]
pub struct Start {
    /// Coefficients of the calibration, and the information behind them if the file has it.
    pub prior: Prior,
    /// Their standard deviations, in the units of eq. (4).
    pub std: [f64; TERMS],
}
