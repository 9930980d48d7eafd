//! Results appear as a whole or not at all.
//!
//! A run that fails, or that finds bad input in the last row of ten million, must not leave half a result behind nor
//! spoil the one of yesterday. So everything is written aside, on the same file system, and renamed at the end.
//!
//! ```no_run
//! use host_sim::output::OutputDir;
//! use std::io::Write;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let output = OutputDir::create("out")?;
//! let mut table = output.create_file("compensated.csv")?;
//! writeln!(table, "time_s,compensated_nT")?;
//! table.finish()?;
//! output.write("summary.json", "{}\n")?;
//! output.commit("summary.json")?;
//! # Ok(())
//! # }
//! ```

mod aside;
mod cleanup;
mod directory;
mod error;
mod file;
mod marker;
mod parents;
mod stream;

pub use self::aside::{Aside, AsideFolder};
pub use self::cleanup::{clean_up_on_signals, wait_if_ending};
pub use self::directory::{OutputDir, StagedFile};
pub use self::error::OutputError;
pub use self::file::OutputFile;
pub use self::marker::claim;
