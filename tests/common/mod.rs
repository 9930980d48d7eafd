//! A card in memory that can lose power, tear, reorder and fail; what the tests write to it; and a board around it, on which
//! the tasks of the firmware run.

// Each test file uses its own part of this.
#![allow(dead_code)]

pub(crate) mod board;
pub(crate) mod body;
pub(crate) mod disk;
pub(crate) mod fat;
pub(crate) mod log;
pub(crate) mod rng;
