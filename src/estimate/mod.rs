//! Estimators of the 18 coefficients: batch elastic net, recursions on a square-root information factor, the adaptive
//! bank, and the steering of the output where coefficients change.
//!
//! Equation numbers are those of the paper that [`crate::model`] cites.

mod adaptive;
mod calibration;
mod elastic_net;
mod estimator;
mod information;
mod level;
mod recursion;
mod rls;
mod robust;
mod saddle_point;
mod singular_values;
mod square_root_information;
mod steering;
mod triangular;

pub use crate::policy::MEMBERS;
pub use adaptive::{Adaptation, Adaptive, Bank, Quality};
pub use calibration::{Calibration, CalibrationError, CalibrationResult};
pub use elastic_net::ElasticNet;
pub use estimator::{Estimator, Fixed};
pub use information::{Information, Prior, TRIANGLE};
pub use level::{LEVEL_COLUMNS, Level, LevelEstimator, LevelOutput, Written};
pub use recursion::RecursiveState;
pub use rls::Rls;
pub use saddle_point::SaddlePoint;
pub use singular_values::singular_values;
pub use square_root_information::SquareRootInformation;
pub use steering::{Steering, SteeringState};
