//! The noise of a channel: its blocks, its colour, where it is louder, and the whitening that follows.

pub(crate) mod blocks;
pub(crate) mod direction;
mod events;
pub(crate) mod louder;
pub(crate) mod model;
pub(crate) mod motion;
mod of_direction;
mod predictor;
mod shape;
pub(crate) mod spectrum;
pub(crate) mod variance;
pub(crate) mod whitening;
