//! Any recording into this project's format.
//!
//! ```text
//! bytes -> formats: Source (tables of columns, nobody has said yet what they mean)
//!              -> meaning: which column is the time, the scalar, the fluxgate, in which unit
//!              -> time, rows, rate: dummies, order, resampling to 10 Hz
//!              -> checks: does the physics agree?
//!              -> the recording, its profile, what was found
//! ```
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod apart;
mod axes;
mod between;
mod by_values;
mod checks;
mod columns;
pub mod compressed;
mod draft;
mod dummies;
pub mod earth_model;
mod error;
mod field;
mod finding;
pub mod formats;
mod meaning;
mod merge;
mod open;
mod options;
mod part;
mod pipeline;
pub mod profile;
mod rate;
mod recording;
mod resample;
mod rows;
pub mod source;
mod stamp;
mod statistics;
mod text;
mod units;

pub use self::checks::standing_still;
pub use self::error::ImportError;
pub use self::finding::Finding;
pub use self::open::{File, Input, read_text};
pub use self::options::Options;
pub use self::pipeline::import;
pub use self::recording::{Recording, Report};
