//! The samples in cells of one length.

use std::collections::VecDeque;

use super::cell::Cell;
use crate::sample::SERIES;

/// Where in a cell the first sample lies: samples of a regular grid then stay clear of the edges, whatever is rounded.
const PHASE: f64 = 0.25;

/// The samples in cells of one length; the oldest go.
#[derive(Clone, Debug)]
pub struct Tier {
    cell_s: f64,
    most: usize,
    origin_s: Option<f64>,
    cells: VecDeque<Cell>,
}

impl Tier {
    /// Cells of this length, as many as the window holds.
    pub(super) fn new(cell_s: f64, window_s: f64) -> Self {
        // One more: the window's first cell is seldom whole.
        let most = (window_s / cell_s).ceil() as usize + 1;
        Self { cell_s, most, origin_s: None, cells: VecDeque::with_capacity(most) }
    }

    /// Add a sample; times rise.
    pub(super) fn push(&mut self, time_s: f64, series: &[Option<f64>; SERIES]) {
        let origin_s = *self.origin_s.get_or_insert(time_s);
        let index = ((time_s - origin_s) / self.cell_s + PHASE) as u64;
        if self.cells.back().is_none_or(|cell| cell.index < index) {
            if self.cells.len() == self.most {
                self.cells.pop_front();
            }
            self.cells.push_back(Cell::new(index, time_s));
        }
        if let Some(cell) = self.cells.back_mut() {
            cell.add(series);
        }
    }

    /// Length of a cell, s.
    pub fn cell_s(&self) -> f64 {
        self.cell_s
    }

    /// The cells, oldest first; times without a sample have none.
    pub fn cells(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter()
    }

    /// The cells that have a sample after a time, s.
    pub fn cells_since(&self, since_s: f64) -> impl Iterator<Item = &Cell> {
        // The cell before the first that starts later may go on beyond it.
        let later = self.cells.partition_point(|cell| cell.time_s <= since_s);
        self.cells.iter().skip(later.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(nt: f64) -> [Option<f64>; SERIES] {
        std::array::from_fn(|place| (place == 1).then_some(nt))
    }

    #[test]
    fn cells_hold_smallest_and_largest_and_the_oldest_go() {
        let mut tier = Tier::new(0.5, 2.0);
        (0..40).for_each(|tick| tier.push(100.0 + 0.1 * f64::from(tick), &value(f64::from(tick))));
        let bounds: Vec<Option<[f64; 2]>> = tier.cells().map(|cell| cell.bounds(1)).collect();
        // A quarter of a cell in front of the first sample: the first cell has four samples, all others five.
        assert_eq!(
            bounds,
            [[14.0, 18.0], [19.0, 23.0], [24.0, 28.0], [29.0, 33.0], [34.0, 38.0], [39.0, 39.0]][1..]
                .iter()
                .copied()
                .map(Some)
                .collect::<Vec<_>>()
        );
        assert!(tier.cells().all(|cell| cell.bounds(0).is_none() && cell.bounds(SERIES).is_none()));
    }

    #[test]
    fn samples_of_a_grid_have_a_cell_each() {
        let mut tier = Tier::new(0.1, 120.0);
        (0..1200).for_each(|tick| tier.push(1.7e9 + 0.1 * f64::from(tick), &value(0.0)));
        assert_eq!(tier.cells().count(), 1200);
    }

    #[test]
    fn since_takes_the_cell_that_is_not_over() {
        let mut tier = Tier::new(1.0, 100.0);
        (0..100).for_each(|tick| tier.push(0.1 * f64::from(tick), &value(1.0)));
        assert_eq!(tier.cells_since(-1.0).count(), tier.cells().count());
        let since: Vec<u64> = tier.cells_since(8.0).map(|cell| cell.index).collect();
        assert_eq!(since, [8, 9, 10]);
        assert_eq!(tier.cells_since(1e9).count(), 1);
    }
}
