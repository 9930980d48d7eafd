//! How strong an effect is, how well it could be found, and making it as strong as it shall be.

mod background;
mod difference;
mod identifiable;
mod projection;
mod size;

pub(crate) use background::{rms, without_background};
pub(crate) use projection::{Column, beside, term_columns};
pub(crate) use size::{sized, sized_mechanism};
