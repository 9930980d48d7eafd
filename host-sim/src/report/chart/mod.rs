//! The charts, as JSON for plotly.js.

mod background;
mod base;
mod candidates;
mod coefficients;
mod driver;
mod gap_map;
mod gap_residual;
mod heading;
mod line;
mod palette;
mod spectrum;
mod time;
mod time_scale;
mod trial;

pub(super) use base::Chart;
use base::{axis, layout, plain};
pub(super) use candidates::{candidates, others};
pub(super) use coefficients::coefficients;
pub(super) use driver::{driver, driver_map};
pub(super) use gap_map::{By, NOT_SIGNIFICANT, gap_map};
pub(super) use gap_residual::{gap_residual, gap_spectra};
pub(super) use heading::heading;
use palette::BEFORE;
pub(super) use palette::{FLUXGATE, Look, SCALAR, looks};
pub(super) use spectrum::spectrum;
pub(super) use time::{dwarfs, stretch_s, time};
pub(super) use trial::{IN_SET, NAMED, Series, reliability, strengths};
