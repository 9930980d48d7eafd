//! Fits of candidates, each in a window of its own beside its neighbours.

use rayon::prelude::*;

use super::{JOINT, Search};
use crate::contacts::dipole::Dipole;
use crate::contacts::fit::{climb, deviation, model_error, modes};
use crate::contacts::stretch::Stretch;
use crate::contacts::way::Spot;
use crate::contacts::window::{Fitted, Source, Window};

/// Fits are bounded by the range of distances, extended by this ratio.
const BEYOND_RANGE: f64 = 1.6;

impl Search<'_> {
    pub(super) fn source<'s>(&'s self, left: &'s [Stretch], stretch: usize, is_even: bool) -> Source<'s> {
        Source {
            noise: &self.noise,
            is_even,
            louder_nt2: self.levelled().variance_nt2,
            way: &self.way,
            stretch_index: stretch,
            stretch: &left[stretch],
        }
    }

    /// Bounds of a distance where the way goes so fast.
    pub(super) fn range(&self, per_s: f64) -> [f64; 2] {
        let [from, to] = self.options.distances_s;
        [from * per_s / BEYOND_RANGE, to * per_s * BEYOND_RANGE]
    }

    /// The window of a contact, what the others explain taken off and what they may change by free.
    fn window<'s>(&'s self, left: &'s [Stretch], index: usize, is_even: bool) -> Option<Window<'s>> {
        let located = &self.found[index];
        let own = located.fitted.dipole;
        let source = self.source(left, located.stretch, is_even);
        let row = self.way.row_at(own.at);
        let cell = source.stretch.cell_near(row)?;
        let mut values = source.stretch.values.clone();
        let known: Vec<(usize, usize)> =
            source.stretch.rows.iter().enumerate().filter_map(|(cell, row)| Some((cell, (*row)?))).collect();
        let spots: Vec<Spot> = known.iter().map(|(_, row)| self.way.spot_of_row(*row)).collect();
        known.iter().zip(own.linear_nt(&self.way, &spots)).for_each(|((cell, _), nt)| values[*cell] += nt);
        let neighbours = self.neighbours(own.at, own.distance, Some(index));
        Window::about(&source, &values, (cell, own.distance / self.way.per_s[row], 0.0), &neighbours)
    }

    /// The contacts, but for one, that are fitted jointly with one at this place of the way and of this distance.
    pub(super) fn neighbours(&self, at: f64, distance: f64, but: Option<usize>) -> Vec<Dipole> {
        let is_near = |dipole: &Dipole| (dipole.at - at).abs() < JOINT * (dipole.distance + distance);
        let others = self.found.iter().enumerate().filter(|(k, _)| Some(*k) != but);
        others.map(|(_, other)| other.fitted.dipole).filter(is_near).collect()
    }

    /// A contact fitted anew, and the window of that.
    fn again<'s>(&'s self, left: &'s [Stretch], index: usize, is_even: bool) -> Option<(Window<'s>, Fitted)> {
        let Dipole { at, distance, side_rad, .. } = self.found[index].fitted.dipole;
        let row = self.way.row_at(at);
        let window = self.window(left, index, is_even)?;
        let fitted = climb(&window, (at, distance), &[side_rad], self.range(self.way.per_s[row]))?;
        Some((window, fitted))
    }

    /// What a contact explains as it was found; the best fits of it, which may be of another distance; their window.
    pub(in crate::contacts) fn modes<'s>(
        &'s self,
        left: &'s [Stretch],
        index: usize,
    ) -> Option<(f64, Vec<Fitted>, Window<'s>)> {
        let (window, fitted) = self.again(left, index, false)?;
        let (glrt, per_s) = (fitted.glrt, self.way.per_s[self.way.row_at(fitted.dipole.at)]);
        let mut modes = modes(&window, fitted, self.range(per_s));
        // Of another distance it may be held by its neighbours, which are free to cancel it.
        modes.retain(|mode| !self.is_cancelled(&mode.dipole));
        Some((glrt, modes, window))
    }

    /// Fits all contacts anew, until none have met and none cancel each other.
    pub(super) fn refit(&mut self) {
        loop {
            let left = self.left();
            let again = |index: usize| {
                let (window, fitted) = self.again(&left, index, self.is_still())?;
                let deviation = deviation(&window, &fitted.dipole, index).unwrap_or_default();
                let model_error = model_error(&window, &fitted);
                Some((fitted, deviation, model_error))
            };
            let fits: Vec<Option<(Fitted, [f64; 5], f64)>> = (0..self.found.len()).into_par_iter().map(again).collect();
            for (located, fitted) in self.found.iter_mut().zip(fits) {
                if let Some((fitted, deviation, model_error)) = fitted {
                    (located.fitted, located.deviation, located.model_error) = (fitted, deviation, model_error);
                }
            }
            if !(self.drops_one_that_met() || self.drops_one_that_is_cancelled()) {
                return;
            }
        }
    }
}
