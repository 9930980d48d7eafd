//! The anomaly on a regular grid, for a map.

mod cells;
mod line_distance;
mod raster;
mod spots;

pub use cells::{MapError, check_cells};
pub use raster::{Raster, anomaly_map};
