//! The 18-term Tolles-Lawson model, its band-pass, and the estimators of its coefficients.
//!
//! Equation numbers are those of Yan, Zhao, Liu, Wu, "An adaptive elastic network magnetic interference compensation
//! method based on saddle point optimization", doi:10.19306/j.cnki.2095-8110.2025.02.005.

mod adaptive;
mod band_pass;
mod basis;
mod calibration;
mod coefficients;
mod elastic_net;
mod estimator;
mod factor;
mod front_end;
mod information;
mod spectrum;
mod steering;
mod terms;

pub use adaptive::{Adaptation, Adaptive, Bank, MEMBERS, Quality};
pub use band_pass::{BandPass, BandPassDesign, BandPassError, BandPassState};
pub use calibration::{Calibration, CalibrationError, CalibrationResult};
pub use coefficients::Coefficients;
pub use elastic_net::ElasticNet;
pub use estimator::{Estimator, Fixed, Rls, SaddlePoint};
pub use factor::{InformationFactor, Row};
pub use front_end::{FrontEnd, FrontEndState, Observation};
pub use information::{Information, Prior, TRIANGLE};
pub use spectrum::singular_values;
pub use steering::{Steering, SteeringState};
pub use terms::{NT_PER_UNIT, TERM_NAMES, TERM_UNITS, Terms, TermsState, UNIT_FIELD_NT};

/// Number of Tolles-Lawson terms: 3 permanent, 6 induced, 9 eddy.
pub const TERMS: usize = 18;

/// One value per Tolles-Lawson term, in the order of [`TERM_NAMES`].
pub type TermVector = [f32; TERMS];

/// Dot product in four interleaved partial sums, always added in the same order: fast on a vector unit, and the
/// same bits everywhere.
fn dot(a: &TermVector, b: &TermVector) -> f32 {
    let mut partial = [0.0_f32; 4];
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        partial[i % 4] += a * b;
    }
    (partial[0] + partial[1]) + (partial[2] + partial[3])
}
