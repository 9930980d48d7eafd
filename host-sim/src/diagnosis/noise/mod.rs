//! The noise of a channel: its blocks, its colour, where it is louder, and the whitening that follows.

pub(crate) mod blocks;
mod courses;
pub(crate) mod direction;
mod direction_spectrum;
mod events;
mod levels;
pub(crate) mod louder;
pub(crate) mod model;
pub(crate) mod motion;
mod of_direction;
pub(crate) mod periodogram;
mod predictor;
mod shape;
pub(crate) mod spectrum;
pub(crate) mod variance;
pub(crate) mod whitening;
