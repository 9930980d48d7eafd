//! The anomaly on a regular grid, for a map.

mod line_distance;
mod raster;
mod spots;

pub use raster::{MapError, Raster, anomaly_map};
