//! The first byte of a record: what follows.

pub(super) const HEADER: u8 = 1;
pub(super) const EPOCH: u8 = 2;
pub(super) const EVENT: u8 = 3;
pub(super) const LOSS: u8 = 4;
