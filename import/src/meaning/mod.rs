//! What the columns of a source mean: by their names and units, and by their values where those do not tell.

mod asked;
mod assign;
mod clock;
mod names;
mod sensors;
mod triples;

pub use self::assign::{Assigned, Meaning, assign};
pub use self::clock::{Times, times};
