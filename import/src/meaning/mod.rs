//! What the columns of a source mean: by their names and units, and by their values where those do not tell.

mod asked;
mod assign;
mod assigned;
mod clock;
mod columns;
mod magnetic;
mod names;
mod others;
mod sensors;
mod triples;

pub(crate) use self::assign::assign;
pub(crate) use self::assigned::{Assigned, Meaning};
pub(crate) use self::clock::{Times, times};

#[cfg(test)]
mod instruments;
