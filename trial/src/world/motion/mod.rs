//! How the body moves: on land, on a lake, at sea, with jerks, in flight. None of it is that of the simulator.

mod course;
mod flight;
mod jerky;
mod lake;
mod land;
mod script;
mod sea;

use super::grid::Grid;
use crate::random::Random;
use crate::setting::Setting;

pub(super) use course::Motion;

/// How many there are, the first three for a diagnosis to be tuned with.
pub(super) fn count(setting: Setting) -> u8 {
    if setting == Setting::Tuning { 3 } else { 5 }
}

/// One of them.
pub(super) fn of(grid: &Grid, which: u8, draw: &mut Random) -> Motion {
    match which {
        0 => land::draw(grid, draw),
        1 => lake::draw(grid, draw),
        2 => sea::draw(grid, draw),
        3 => jerky::draw(grid, draw),
        _ => flight::draw(grid, draw),
    }
}
