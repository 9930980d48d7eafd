//! The rules of the house, read from the source: which file uses which, where strings stand, how long functions are.

mod arrows;
mod cfg_test;
mod circles;
pub mod functions;
mod mentions;
mod scope;
mod source;
pub mod strings;

pub use arrows::{Arrow, arrows};
pub use circles::{Circle, circles};
pub use source::{Module, SourceCrate, on_disk};
