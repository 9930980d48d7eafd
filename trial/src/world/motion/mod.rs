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

/// How many there are.
pub(super) const COUNT: u8 = 5;

/// One of them; where a diagnosis is tuned, jerks are those of a hand on land.
pub(super) fn of(grid: &Grid, which: u8, setting: Setting, draw: &mut Random) -> Motion {
    match (which, setting) {
        (0, _) => land::draw(grid, draw),
        (1, _) => lake::draw(grid, draw),
        (2, _) => sea::draw(grid, draw),
        (3, Setting::Trial) => jerky::draw(grid, draw),
        (3, Setting::Tuning) => jerky::knocked(grid, draw),
        _ => flight::draw(grid, draw),
    }
}
