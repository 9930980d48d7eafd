//! Dipole targets along the track: a matched subspace detector with the measured noise, and fits of what it finds.

mod alternatives;
mod bands;
mod body;
mod covariance;
mod dipole;
mod fit;
mod found;
mod geometry;
mod heading;
mod levelled;
mod merge;
mod noise;
mod null;
mod pass;
mod posterior;
mod scan;
mod search;
mod second_order;
mod shape;
mod sight;
mod smallest;
mod spectrum;
mod stretch;
mod told;
mod triangulation;
mod way;
mod whitening;
mod window;

pub use dipole::{Dipole, profiles};
pub(crate) use found::find_again;
pub use found::{Found, find};
pub use levelled::{Levelled, Options, WayBy};
pub use merge::merge;
pub use noise::Noise;
pub use pass::Pass;
pub use smallest::smallest_moments_am2;
