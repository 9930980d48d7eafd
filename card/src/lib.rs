//! The body's card on the desk: lays out its log files with the body's own code, and tries whether it is fit.
//!
//! | module | |
//! |---|---|
//! | `store` | an image or a device as bytes |
//! | `blocks` | the same as the card that the body's code knows; `rehearsal`: one whose writes stay in memory at first |
//! | `listing` | what is on a card, and what keeps it from being the body's |
//! | `mounts`, `guard`, `place` | what was named, and whether it may be written to |
//! | `prepare` | log files, marked to their end |
//! | `fitness` | capacity, pauses and speed |
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]

mod blocks;
mod error;
pub mod fitness;
mod guard;
mod listing;
mod mounts;
mod place;
mod prepare;
mod rehearsal;
mod store;

pub use error::CardError;
pub use listing::{Item, Listing};
pub use place::{Consent, Place};
pub use prepare::{Prepared, Wanted, prepare};
pub use store::{Access, DiskFile, Store};

/// Bytes of a block, in the unit of files and devices.
pub const BLOCK_BYTES: u64 = 512;

/// Who is told how far the work is.
pub trait Progress {
    /// The next part begins, of so many bytes.
    fn begin(&self, what: &'static str, bytes: u64);

    /// So many more are done.
    fn add(&self, bytes: u64);
}

/// Nobody.
impl Progress for () {
    fn begin(&self, _: &'static str, _: u64) {}

    fn add(&self, _: u64) {}
}
