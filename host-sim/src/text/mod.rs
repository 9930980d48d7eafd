//! Results in plain words, for the terminal and the pages: the answer first, with its numbers.

pub mod clock;
pub mod diagnosis;
mod diagnosis_headline;
pub mod diagnosis_json;
pub mod diagnosis_targets;
pub mod diagnosis_terminal;
pub mod manoeuvre;
pub mod mismatch;
pub mod number;
pub mod plan;
mod quantity;
pub mod replay;
pub mod residual;
pub mod survey;
pub mod trial;
pub(crate) mod unexplained;
pub(crate) mod wrap;
