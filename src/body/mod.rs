//! What the tasks of the firmware do with data, without the tasks: the same code runs in `host-sim emulate`, which holds
//! the emulated body against it.

mod after_reset;
mod build;
mod clock_notice;
mod converter;
mod record_builder;
mod time_of_day;

pub use after_reset::after_reset;
pub use build::{Built, Firmware, build, build_pipeline};
pub use clock_notice::tell_clock;
pub use converter::{Conversion, Converter};
pub use record_builder::{RecordBuilder, fault, faults_of};
pub use time_of_day::{TimeOfDay, UnixTime};
