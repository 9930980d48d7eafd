//! What a recorder rounds its readings to, found from the values: part of the base model, and no gap by itself.

mod lattice;
mod stretch;
#[cfg(test)]
mod tests;

pub(crate) use lattice::Lattice;
pub(crate) use stretch::Stretch;

use super::reconstruct::prepared::Prepared;
use stretch::stretches;

/// The steps of both sensors along a recording.
#[derive(Clone, Debug)]
pub(crate) struct Rounding {
    pub(crate) scalar: Vec<Stretch>,
    /// Of each component.
    pub(crate) fluxgate: [Vec<Stretch>; 3],
}

impl Rounding {
    pub(crate) fn of(table: &Prepared) -> Self {
        let component = |axis: usize| {
            let values: Vec<f64> = table.flux_nt.iter().map(|flux| flux[axis]).collect();
            stretches(&values, table.flux_resolution_nt[axis])
        };
        let scalar = || stretches(&table.scalar_nt, table.scalar_resolution_nt);
        let (scalar, (x, (y, z))) =
            rayon::join(scalar, || rayon::join(|| component(0), || rayon::join(|| component(1), || component(2))));
        Self { scalar, fluxgate: [x, y, z] }
    }

    /// The step of the scalar at each row, nT.
    pub(crate) fn scalar_steps_nt(&self) -> Vec<f64> {
        self.scalar.iter().flat_map(|stretch| std::iter::repeat_n(stretch.step, stretch.rows.len())).collect()
    }

    /// Noise that rounding adds to a reading of the scalar, nT^2.
    pub(crate) fn scalar_power_nt2(&self) -> f64 {
        power(&self.scalar)
    }

    /// Noise that rounding adds to the magnitude of the fluxgate vector, nT^2: that of each component as far as it lies
    /// along the field.
    pub(crate) fn fluxgate_power_nt2(&self, table: &Prepared) -> f64 {
        let mut along = [0.0; 3];
        for flux in table.flux_nt.iter().filter(|flux| flux[0].is_finite()) {
            (0..3).for_each(|axis| along[axis] += flux[axis] * flux[axis]);
        }
        let all: f64 = along.iter().sum();
        self.fluxgate.iter().zip(along).map(|(component, along)| power(component) * along / all.max(1e-9)).sum()
    }
}

/// The largest step, nT; 0 without a row.
pub(crate) fn coarsest_nt<'a>(stretches: impl IntoIterator<Item = &'a Stretch>) -> f64 {
    stretches.into_iter().map(|stretch| stretch.step).fold(0.0, f64::max)
}

/// Mean over the rows of a twelfth of the step's square: the variance of what rounding takes away.
fn power(stretches: &[Stretch]) -> f64 {
    let rows: usize = stretches.iter().map(|stretch| stretch.rows.len()).sum();
    let sum: f64 = stretches.iter().map(|stretch| stretch.rows.len() as f64 * stretch.step.powi(2)).sum();
    sum / 12.0 / rows.max(1) as f64
}
