//! The formats, by name.

use std::fmt;
use std::str::FromStr;

use crate::error::ExportError;
use crate::formats::{geojson, gpkg, hdf5, mcap, parquet, xyz};
use crate::table::Table;

/// A format that other tools read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Geosoft XYZ: text, line by line.
    Xyz,
    /// GeoJSON, RFC 7946.
    Geojson,
    /// OGC GeoPackage.
    Gpkg,
    /// Apache Parquet.
    Parquet,
    /// MCAP with JSON messages.
    Mcap,
    /// HDF5 as MagNav has it.
    Hdf5,
}

/// What can be asked of a format. All but GeoJSON take all rows as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// GeoJSON: seconds between the rows that are taken; all without.
    pub every_s: Option<f64>,
    /// GeoJSON: a point a row as well, with all its columns.
    pub points: bool,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 6] = [Self::Xyz, Self::Geojson, Self::Gpkg, Self::Parquet, Self::Mcap, Self::Hdf5];

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Xyz => "xyz",
            Self::Geojson => "geojson",
            Self::Gpkg => "gpkg",
            Self::Parquet => "parquet",
            Self::Mcap => "mcap",
            Self::Hdf5 => "hdf5",
        }
    }

    /// What it is, and who reads it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Xyz => "Geosoft XYZ: Oasis montaj and most programs for potential fields",
            Self::Geojson => "GeoJSON: the track for a map on a page, and for QGIS",
            Self::Gpkg => "GeoPackage: track and samples with all columns, for QGIS",
            Self::Parquet => "Parquet: pandas, polars, DuckDB",
            Self::Mcap => "MCAP with JSON messages: PlotJuggler and Foxglove",
            Self::Hdf5 => "HDF5 with the names of MagNav: h5py, Julia, Matlab",
        }
    }

    /// Whether it is text, which a terminal or a pipe takes.
    pub fn is_text(self) -> bool {
        matches!(self, Self::Xyz | Self::Geojson)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|format| format.name() == name).ok_or_else(|| format!("is none of {}", names()))
    }
}

/// The table as a file of this format: whole, so that nothing is written where something is wrong.
///
/// # Errors
///
/// When the table lacks what the format needs, or holds what it cannot.
pub fn encode(table: &Table, format: Format, options: &Options) -> Result<Vec<u8>, ExportError> {
    match format {
        Format::Xyz => Ok(xyz::encode(table)),
        Format::Geojson => geojson::encode(table, options.every_s, options.points),
        Format::Gpkg => gpkg::encode(table),
        Format::Parquet => parquet::encode(table),
        Format::Mcap => mcap::encode(table),
        Format::Hdf5 => hdf5::encode(table),
    }
}
