//! Recordings and results for other tools.
//!
//! ```text
//! CSV file -> read -> Table of typed columns -> encode -> bytes of a Geosoft XYZ, GeoJSON, GeoPackage, ... file
//! ```
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod error;
mod format;
mod formats;
mod legs;
mod position;
mod raster;
mod read;
mod table;
mod units;

pub use self::error::ExportError;
pub use self::format::{Format, Options, encode};
pub use self::formats::geojson::cut_at_the_antimeridian;
pub use self::raster::{Raster, geotiff};
pub use self::read::{find, read, read_from};
pub use self::table::{Table, TableColumn, Values};
