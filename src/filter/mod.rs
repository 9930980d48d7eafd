//! The band in which coefficients are estimated and residuals are judged.

mod band_pass;
mod design;

pub(crate) use band_pass::STATES;
pub use band_pass::{BandPass, BandPassState};
pub use design::{BandPassDesign, BandPassError};
