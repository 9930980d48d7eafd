//! What the two sensors say, and what is done to it.

use super::vector::{Vector, length};

/// What the two sensors say at each row.
#[derive(Clone, Debug)]
pub(crate) struct Readings {
    pub(crate) scalar_nt: Vec<f64>,
    pub(crate) flux_nt: Vec<Vector>,
}

/// Values that are added to the clean readings; empty where a sensor is not touched.
#[derive(Clone, Debug, Default)]
pub(crate) struct Change {
    pub(crate) scalar_nt: Vec<f64>,
    pub(crate) flux_nt: Vec<Vector>,
}

/// What happens to the readings when all else is done, noise included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Last {
    /// The scalar's reading is repeated with this probability.
    Repeat(f64),
    /// The fluxgate's components are rounded to this, nT.
    Round(f64),
}

impl Readings {
    /// What an effect changes.
    pub(crate) fn add(&mut self, change: &Change) {
        self.scalar_nt.iter_mut().zip(&change.scalar_nt).for_each(|(nt, off)| *nt += off);
        self.flux_nt.iter_mut().zip(&change.flux_nt).for_each(|(nt, off)| (0..3).for_each(|k| nt[k] += off[k]));
    }
}

impl Change {
    /// Of the scalar alone, nT at each row.
    pub(crate) fn of_scalar(scalar_nt: Vec<f64>) -> Self {
        Self { scalar_nt, ..Self::default() }
    }

    /// As many times as large.
    pub(crate) fn times(mut self, by: f64) -> Self {
        self.scalar_nt.iter_mut().chain(self.flux_nt.iter_mut().flatten()).for_each(|nt| *nt *= by);
        self
    }
}

/// Magnitudes of the fluxgate's readings, nT.
pub(crate) fn magnitudes(flux_nt: &[Vector]) -> Vec<f64> {
    flux_nt.iter().map(|&reading| length(reading)).collect()
}
