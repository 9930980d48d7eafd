//! Fluxgate readings in steps that add to its noise: no fit is needed, the values say the step.

use crate::diagnosis::policy::ROUNDING_MOST_ADDED;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::rounding::{Lattice, Rounding, Stretch};

/// Steps from the lattice up to which a value counts as on it.
const ON: f64 = 0.25;

/// The grid that a component of the fluxgate lies on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuantisationGrid {
    pub(crate) step_nt: f64,
    /// Its standard error.
    pub(crate) step_error_nt: f64,
    /// Share of the values of the second half that lie on the grid of the first, and how many they are.
    pub(crate) held_out: f64,
    pub(crate) values: usize,
}

/// The grid that adds most, if all steps together add more to the noise of the fluxgate than a recorder may. `noise_nt2` is
/// the power of that noise, in the magnitude, with what rounding adds.
pub(crate) fn quantisation_grid(table: &Prepared, rounding: &Rounding, noise_nt2: f64) -> Option<QuantisationGrid> {
    let added_nt2 = rounding.fluxgate_power_nt2(table);
    if added_nt2 <= ROUNDING_MOST_ADDED * (noise_nt2 - added_nt2) {
        return None;
    }
    let stretches = rounding.fluxgate.iter().enumerate().flat_map(|(axis, all)| all.iter().map(move |one| (axis, one)));
    let weight = |stretch: &Stretch| stretch.rows.len() as f64 * stretch.step.powi(2);
    let (axis, most) = stretches.max_by(|(_, a), (_, b)| weight(a).total_cmp(&weight(b)))?;
    let values: Vec<f64> =
        table.flux_nt[most.rows.clone()].iter().map(|flux| flux[axis]).filter(|nt| nt.is_finite()).collect();
    let (first, second) = values.split_at(values.len() / 2);
    let held_out = match Lattice::of(first, table.flux_resolution_nt[axis]) {
        Some(lattice) => second.iter().filter(|value| lattice.off(**value) <= ON).count() as f64 / second.len() as f64,
        // The step is that of the last digit, which no value can miss.
        None => 1.0,
    };
    Some(QuantisationGrid { step_nt: most.step, step_error_nt: most.step_error(), held_out, values: second.len() })
}
