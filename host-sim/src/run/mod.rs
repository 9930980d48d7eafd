//! A recording through the core, and what comes of it.

mod adaptation;
mod coefficient_check;
mod collectors;
mod counts;
mod method;
mod pass;
mod result;
mod start;

pub use self::adaptation::{AdaptationCounts, AdaptationSummary};
pub use self::coefficient_check::{Change, CoefficientCheck, Explanation, Mismatch};
pub use self::collectors::{MethodCollector, MethodRow, RecordingCollector, Row, SETTLED_S};
pub use self::counts::Counts;
pub use self::method::{difference_nt, method_name};
pub use self::pass::{Passed, PassedRow, pass, pass_given};
pub use self::result::{Coefficient, MethodResult, Settled, Uncompensated};
pub use self::start::Start;
