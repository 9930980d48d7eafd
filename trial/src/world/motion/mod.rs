//! How the body moves: on land, on a lake, at sea. None of it is that of the simulator.

mod course;
mod lake;
mod land;
mod script;
mod sea;

use super::grid::Grid;
use crate::random::Random;

pub(super) use course::Motion;

/// One of the three.
pub(super) fn of(grid: &Grid, which: u8, draw: &mut Random) -> Motion {
    match which {
        0 => land::draw(grid, draw),
        1 => lake::draw(grid, draw),
        _ => sea::draw(grid, draw),
    }
}
