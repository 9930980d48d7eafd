//! Readers of formats: each knows its own by its first bytes, and gives a [`Source`](crate::source::Source).

mod aseg_definition;
mod aseg_gdf2;
mod civil;
mod fields;
mod format;
mod geosoft_record;
mod geosoft_xyz;
mod iaga_2002;
mod iaga_header;
mod leap_seconds;
mod magnav_hdf5;
mod mat;
mod memory;
mod mgd77t;
mod named_only;
mod nmea_epochs;
mod nmea_foreign;
mod nmea_log;
mod nmea_sentence;
mod rtklib_header;
mod rtklib_pos;
mod rtklib_time;
mod spreadsheet;

pub use self::format::{Input, LARGEST_GROWTH, SourceFormat};

/// The formats that are recognised by what they are; delimited text is what none of them is.
///
/// The first that recognises a file reads it: those that are only named come last.
pub static FORMATS: &[&dyn SourceFormat] = &[
    &magnav_hdf5::MagNavHdf5,
    &mat::Mat,
    &spreadsheet::Spreadsheet,
    &iaga_2002::Iaga2002,
    &aseg_gdf2::AsegGdf2,
    &mgd77t::Mgd77t,
    &rtklib_pos::RtklibPos,
    &nmea_log::NmeaLog,
    &geosoft_xyz::GeosoftXyz,
    &named_only::NamedOnly,
];
