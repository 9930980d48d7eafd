//! The 18-term Tolles-Lawson model, its band-pass, and the estimators of its coefficients.
//!
//! Equation numbers are those of Yan, Zhao, Liu, Wu, "An adaptive elastic network magnetic interference compensation
//! method based on saddle point optimization", doi:10.19306/j.cnki.2095-8110.2025.02.005.

mod band_pass;
mod calibration;
mod coefficients;
mod elastic_net;
mod estimator;
mod factor;
mod front_end;
mod spectrum;
mod terms;

pub use band_pass::{BandPass, BandPassDesign, BandPassError, BandPassState};
pub use calibration::{Calibration, CalibrationError, CalibrationResult};
pub use coefficients::Coefficients;
pub use elastic_net::ElasticNet;
pub use estimator::{Estimator, Fixed, Rls, SaddlePoint};
pub use factor::{InformationFactor, Row};
pub use front_end::{FrontEnd, FrontEndState, Observation};
pub use spectrum::singular_values;
pub use terms::{NT_PER_UNIT, TERM_NAMES, TERM_UNITS, Terms, TermsState, UNIT_FIELD_NT};

/// Number of Tolles-Lawson terms: 3 permanent, 6 induced, 9 eddy.
pub const TERMS: usize = 18;

/// One value per Tolles-Lawson term, in the order of [`TERM_NAMES`].
pub type TermVector = [f32; TERMS];
