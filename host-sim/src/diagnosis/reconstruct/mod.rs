//! The simulator's clean signals, reconstructed from a recording.

pub(crate) mod direction_noise;
pub(crate) mod prepared;
pub(crate) mod reconstruction;
pub(crate) mod smooth;
pub(crate) mod tangent_plane;
