//! A card in memory that can lose power, tear, reorder and fail; and what the tests write to it.

// Each test file uses its own part of this.
#![allow(dead_code)]

pub(crate) mod disk;
pub(crate) mod fat;
pub(crate) mod log;
pub(crate) mod rng;
