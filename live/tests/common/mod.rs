//! What tests of the live page share.
#![allow(dead_code, reason = "each test uses a part of it")]

pub(crate) mod browser;
pub(crate) mod demo;
pub(crate) mod raw;
