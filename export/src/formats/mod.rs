//! One file a format. Each makes the whole of a file from a table.

pub(crate) mod geojson;
pub(crate) mod gpkg;
pub(crate) mod hdf5;
mod json;
pub(crate) mod mcap;
pub(crate) mod parquet;
mod track;
pub(crate) mod xyz;
