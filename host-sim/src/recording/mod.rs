//! Recordings of any format, as typed rows: constant memory, whatever their length. Or as a whole [`Table`] of typed
//! columns, each with the resolution that it is written with.
//!
//! ```text
//! file -> Format (recognised by its first bytes) -> RecordingReader -> RecordingRow -> towmag::Epoch
//!                                                   Schema: columns    typed values, held against the contract
//!                                                                         \-> Table
//! ```
//!
//! ```no_run
//! use host_sim::recording::{self, RecordingRow};
//!
//! # fn main() -> Result<(), host_sim::recording::RecordingError> {
//! let mut recording = recording::open("rec.csv".as_ref())?;
//! let mut row = RecordingRow::default();
//! while recording.read_row(&mut row)? {
//!     println!("{} {:?}", row.line_number, row.epoch);
//! }
//! # Ok(())
//! # }
//! ```

mod bad_rows;
mod clock;
mod error;
mod formats;
mod input;
mod rate;
mod rate_check;
mod reader;
mod row;
mod schema;
mod session_gap;
mod stamps;
mod table;
mod ticks;

pub use self::bad_rows::{BadRow, BadRows, RowFault};
pub use self::clock::utc_offset_s;
pub use self::error::{BadInput, RecordingError};
pub use self::formats::csv::CsvReader;
pub use self::formats::device_log::{DeviceLogReader, FileBlocks, is_device_log, prior_from_log, survey};
pub use self::formats::{FORMATS, open, open_as_one_of};
pub use self::input::Input;
pub use self::rate::{EPOCH_S, LONGEST_STEP_S, RATE_HZ, TIME_ROUNDING_S};
pub use self::reader::{FieldSink, Format, Opened, RecordingReader};
pub use self::row::RecordingRow;
pub use self::schema::{LoadColumn, Schema};
pub use self::session_gap::SessionGap;
pub use self::table::{ColumnValues, Table, TableColumn};
pub use self::ticks::{Tick, TickCounter};
pub use towmag_recording::{COLUMNS, Column, ColumnKind, ColumnSpec, LOAD_UNIT, load_of};
