//! Recordings as a stream of epochs: constant memory, whatever their length. CSV, or the log that the body writes.
//!
//! ```text
//! bytes -> Lines -> csv::Reader -> RecordingRow::parse -> Clock -> RecordingRow with its towmag::Epoch
//!          physical                values, and what       ticks
//!          line numbers            counts as bad input    and gaps
//! ```
//!
//! ```no_run
//! use host_sim::recording::{Recording, RecordingRow};
//!
//! # fn main() -> Result<(), host_sim::recording::RecordingError> {
//! let mut recording = Recording::open("rec.csv")?;
//! let mut row = RecordingRow::default();
//! while recording.read_row(&mut row)? {
//!     println!("{} {:?}", row.line_number, row.epoch);
//! }
//! # Ok(())
//! # }
//! ```

mod clock;
mod columns;
mod csv;
mod device_log;
mod error;
mod lines;
mod row;
mod rows;

pub use self::columns::{Columns, LoadColumn};
pub use self::csv::Recording;
pub use self::device_log::{DeviceLog, FileBlocks, prior_told, survey};
pub use self::error::RecordingError;
pub use self::row::RecordingRow;
pub use self::rows::{Rows, open, starts_as_log};
