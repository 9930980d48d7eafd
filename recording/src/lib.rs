//! What a recording is, for all who read, import or export one: its columns with their units, and the range of a reading.
//!
//! Nothing here is for the microcontroller: there the library is empty.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

mod column;

pub use self::column::{COLUMNS, Column, ColumnKind, ColumnSpec, LOAD_UNIT, load_of};

/// What the total field can be on Earth, with room to spare, nT.
pub const FIELD_RANGE_NT: std::ops::RangeInclusive<f64> = 1_000.0..=100_000.0;
