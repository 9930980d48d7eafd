//! How far apart the lines are.

use std::collections::BTreeMap;

use super::spots::Spot;
use crate::statistics::median;

/// One row in so many is looked at: a place a second.
const EVERY: usize = 10;
/// From so many places the nearest other line is looked for; the median of more is no better.
const PLACES: usize = 500;

/// Lines nearer than this share of the distance to the next ones are the same line flown again, or one that crosses it,
const SAME_LINE: f64 = 0.2;
/// if they are nearer than this, m, too: so well a line is kept;
const SAME_LINE_M: f64 = 2.0;
/// no more than so many times.
const MOST_AGAIN: usize = 4;

/// The usual distance from a line to the nearest other one, m: the median over places on lines. `None` with fewer than two, or if they lie
/// further apart than they are long: then they are of different places.
pub(crate) fn line_distance_m(spots: &[Spot]) -> Option<f64> {
    let on_lines: Vec<Spot> = spots.iter().filter(|spot| spot.line > 0).step_by(EVERY).copied().collect();
    let every = on_lines.len().div_ceil(PLACES).max(1);
    let lengths_m = lengths_m(&on_lines);
    let beside = |spot: &Spot| to_next_m(spot, &on_lines).filter(|distance_m| *distance_m <= lengths_m[&spot.line]);
    let mut distances: Vec<f64> = on_lines.iter().step_by(every).filter_map(beside).collect();
    median(&mut distances)
}

/// How long each line is: the diagonal of what it lies in, m.
fn lengths_m(on_lines: &[Spot]) -> BTreeMap<usize, f64> {
    let mut boxes: BTreeMap<usize, [[f64; 2]; 2]> = BTreeMap::new();
    for Spot { line, place_m, .. } in on_lines {
        let [low, high] = boxes.entry(*line).or_insert([*place_m; 2]);
        (0..2).for_each(|axis| {
            (low[axis], high[axis]) = (low[axis].min(place_m[axis]), high[axis].max(place_m[axis]));
        });
    }
    boxes.into_iter().map(|(line, [low, high])| (line, (high[0] - low[0]).hypot(high[1] - low[1]))).collect()
}

/// To the nearest line that is not the same flown again.
fn to_next_m(spot: &Spot, all: &[Spot]) -> Option<f64> {
    let mut nearest: BTreeMap<usize, f64> = BTreeMap::new();
    for other in all.iter().filter(|other| other.line != spot.line) {
        let [x, y] = [0, 1].map(|axis: usize| other.place_m[axis] - spot.place_m[axis]);
        let square = nearest.entry(other.line).or_insert(f64::INFINITY);
        *square = square.min(x * x + y * y);
    }
    let mut distances: Vec<f64> = nearest.into_values().map(f64::sqrt).collect();
    distances.sort_by(f64::total_cmp);
    let is_again = |pair: &&[f64]| pair[0] < SAME_LINE_M.min(SAME_LINE * pair[1]);
    let after = distances.windows(2).take(MOST_AGAIN).rfind(is_again);
    after.map(|pair| pair[1]).or(distances.first().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines to the north at these eastings, 100 m long, a place every 0.2 m.
    fn lines(east_m: &[f64]) -> Vec<Spot> {
        let line = |(line, east_m): (usize, f64)| {
            (0..500).map(move |k| Spot { place_m: [east_m, 0.2 * f64::from(k)], line, ..Spot::default() })
        };
        (1..).zip(east_m.iter().copied()).flat_map(line).collect()
    }

    #[test]
    fn lines_flown_again_are_no_neighbours() {
        let close = |east_m: &[f64], distance_m: f64| {
            let found = line_distance_m(&lines(east_m)).unwrap();
            assert!((found - distance_m).abs() < 0.1 * distance_m, "{east_m:?}: {found}");
        };
        close(&[0.0, 20.0, 40.0, 60.0], 20.0);
        close(&[0.0, 20.0, 40.0, 60.0, 0.4, 20.3, 39.5, 60.2], 20.0);
        close(&[0.0, 20.0, 40.0, 0.4, 20.3, 39.5, 0.2, 20.1, 40.3], 20.0);
        close(&[0.0, 0.5, 1.0, 1.5, 2.0], 0.5);
        // Two areas.
        close(&[0.0, 10.0, 20.0, 600.0, 610.0, 620.0], 10.0);
        assert_eq!(line_distance_m(&lines(&[0.0])), None);
        // Two lines of different places.
        assert_eq!(line_distance_m(&lines(&[0.0, 300_000.0])), None);
    }
}
