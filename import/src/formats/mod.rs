//! Readers of formats: each knows its own by its first bytes, and gives a [`Source`](crate::source::Source).

mod brackets;
mod fields;
mod magnav_hdf5;
mod mat;
mod memory;
mod reader;
mod spreadsheet;

pub use self::reader::{Input, LARGEST_GROWTH, SourceFormat};

/// The formats that are recognised by what they are; delimited text is what none of them is.
pub static FORMATS: &[&dyn SourceFormat] = &[&magnav_hdf5::MagNavHdf5, &mat::Mat, &spreadsheet::Spreadsheet];
