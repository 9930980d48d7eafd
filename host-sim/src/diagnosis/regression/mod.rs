//! One channel as a regression problem: whitened columns, projections, joint fits.

pub(crate) mod problem;
pub(crate) mod products;
pub(crate) mod projection;
pub(crate) mod term;
