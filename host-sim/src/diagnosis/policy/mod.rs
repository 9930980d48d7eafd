//! Constants that decide something in a diagnosis, by stage: thresholds, limits, trials factors, tolerances.
//!
//! Sizes of a search, orders of an algorithm and physical constants stand where they are used. A whitened residual has
//! noise of variance 1; a GLRT is twice the log likelihood ratio, and so in units of that variance.
//!
//! Each constant says where it comes from: *derived*, by the sentence beside it; *counted*, on recordings of `host-sim
//! trial`; or *set by hand*, while the diagnosis was made on such recordings: then nothing but `host-sim trial` on other
//! seeds says how good it is, and that only for what the trial draws.

mod columns;
mod drivers;
mod noise;
mod reconstruction;
mod rest;
mod search;
mod selection;
mod targets;
mod verdict;

pub(crate) use columns::*;
pub(crate) use drivers::*;
pub(crate) use noise::*;
pub(crate) use reconstruction::*;
pub(crate) use rest::*;
pub(crate) use search::*;
pub(crate) use selection::*;
pub(crate) use targets::*;
pub(crate) use verdict::*;

/// Rows per second of a recording, and the time from row to row, s.
pub(crate) use crate::recording::{EPOCH_S, RATE_HZ};
