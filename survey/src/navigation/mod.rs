//! Where the body was: a track in metres, its lines, and the field's change with the day.
//!
//! ```text
//! rows -> fixes (positions in metres, outliers dropped, jumps told) -> smoother -> path (position and velocity at any time)
//!      -> layback (from the ship to the body) -> Track a row -> lines
//! ```

mod base_outliers;
mod base_share;
mod base_station;
mod diurnal;
mod error;
mod fix;
mod fixes;
mod jumps;
mod layback;
mod lines;
mod moving_mean;
mod navigate;
mod options;
mod path;
mod projection;
mod smoother;
mod track;

pub(crate) use base_share::share;
pub use base_station::{BaseStation, BaseTimes};
pub use diurnal::{Diurnal, Faults, diurnal};
pub use error::NavigationError;
pub use jumps::ReceiverFault;
pub use navigate::{Navigated, Navigation, navigate};
pub use options::{Layback, NavigationOptions, PositionOf};
pub use projection::Grid;
pub use track::Track;
