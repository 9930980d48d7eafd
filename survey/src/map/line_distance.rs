//! How far apart the lines are.

use super::spots::Spot;
use crate::statistics::median;

/// One row in so many is looked at: a place a second.
const EVERY: usize = 10;
/// From so many places the nearest other line is looked for; the median of more is no better.
const PLACES: usize = 500;

/// The usual distance from a line to the nearest other one, m: the median over places on lines. `None` with fewer than two.
pub(crate) fn line_distance_m(spots: &[Spot]) -> Option<f64> {
    let on_lines: Vec<Spot> = spots.iter().filter(|spot| spot.line > 0).step_by(EVERY).copied().collect();
    let every = on_lines.len().div_ceil(PLACES).max(1);
    let mut distances: Vec<f64> =
        on_lines.iter().step_by(every).filter_map(|spot| nearest_m(spot, &on_lines)).collect();
    median(&mut distances)
}

fn nearest_m(spot: &Spot, all: &[Spot]) -> Option<f64> {
    let others = all.iter().filter(|other| other.line != spot.line);
    let squares = others.map(|other| {
        let [x, y] = [0, 1].map(|axis: usize| other.place_m[axis] - spot.place_m[axis]);
        x * x + y * y
    });
    squares.min_by(f64::total_cmp).map(f64::sqrt)
}
