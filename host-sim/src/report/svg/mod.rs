//! Charts that need no library: lines that stretch with the page, and labels that do not.
//!
//! The drawing area is an SVG that is stretched to its box; strokes keep their width, and all text is HTML at shares of
//! the box. So one drawing fits a wide screen and a phone, prints, and shows without a script; a script only reads values.

mod axis;
mod line;
mod ticks;

pub(super) use axis::Axis;
pub(super) use line::{Line, Mark, Plot, path};
pub(super) use ticks::round_step;
