//! Effects that users write in a TOML file: the language is `towmag-effect-file`'s, this makes one of them an
//! [`Effect`](super::Effect) like those of the program.

mod course;
mod effect;
mod filter;
mod spec;
mod trial_values;

pub use effect::FileEffect;
pub(crate) use filter::{held, played};
