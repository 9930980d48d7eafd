//! The band in which coefficients are estimated and residuals are judged.

mod band_pass;

pub(crate) use band_pass::STATES;
pub use band_pass::{BandPass, BandPassDesign, BandPassError, BandPassState};
