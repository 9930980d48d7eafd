//! What a fit leaves of the scalar, whitened to noise of variance 1, and fits of a dipole to it.

use std::ops::Range;

use super::dipole::Dipole;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::regression::problem::solve;

/// Rows that count as those of a dipole, in distances.
const OWN_DISTANCES: f64 = 2.5;

/// The whitened residual of a fit.
pub(super) struct Residual<'a> {
    pub(super) whitening: &'a Whitening,
    /// Times of the rows since the first one, s.
    pub(super) epochs_s: &'a [f64],
    /// One a sample, the noise of variance 1.
    pub(super) z: Vec<f64>,
    /// The row of each sample, ascending.
    pub(super) row_of: Vec<usize>,
    /// What the whitened residual of the fit was divided by.
    pub(super) scale: f64,
}

/// A dipole, and what it does to the residual.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    pub(super) dipole: Dipole,
    /// What it explains, whitened.
    pub(super) glrt: f64,
    /// Mean square of what is left where it is, whitened.
    pub(super) left: f64,
}

impl<'a> Residual<'a> {
    /// Of what a whitening makes of the residual.
    pub(super) fn of(whitening: &'a Whitening, epochs_s: &'a [f64], whitened: &[f64]) -> Self {
        let scale = robust_mean_square(whitened).sqrt().max(f64::MIN_POSITIVE);
        let z = whitened.iter().map(|z| z / scale).collect();
        Self { whitening, epochs_s, z, row_of: whitening.rows().collect(), scale }
    }

    /// One value a row, whose sum of products with any column is that of the whitened residual with the whitened column.
    pub(super) fn adjoint(&self) -> Vec<f64> {
        let mut adjoint = self.whitening.transposed(&self.z, self.epochs_s.len());
        // The columns, too, are to be in units of the noise.
        adjoint.iter_mut().for_each(|value| *value /= self.scale);
        adjoint
    }

    /// Samples of the rows within a distance of a row.
    pub(super) fn samples_near(&self, row: usize, rows: usize) -> Range<usize> {
        let first = self.row_of.partition_point(|other| *other + rows < row);
        first..self.row_of.partition_point(|other| *other <= row + rows)
    }

    /// What a dipole explains, its amplitudes at their best here.
    pub(super) fn judged(&self, dipole: &Dipole) -> Fitted {
        let (epochs_s, whitening) = (self.epochs_s, self.whitening);
        let (mut columns, mut target, mut rows) = (vec![Vec::new(); 3], Vec::new(), Vec::new());
        let reach_s = 6.0 * dipole.distance_s;
        for (index, (block, range)) in whitening.blocks().iter().zip(whitening.ranges()).enumerate() {
            let (first_s, last_s) = (epochs_s[block.rows.start], epochs_s[block.rows.end - 1]);
            if last_s < dipole.epoch_s - reach_s || first_s > dipole.epoch_s + reach_s {
                continue;
            }
            let raw = dipole.columns(&epochs_s[block.rows.clone()]);
            for (column, raw) in columns.iter_mut().zip(&raw) {
                column.extend(whitening.apply_block(index, raw).into_iter().map(|x| x / self.scale));
            }
            target.extend_from_slice(&self.z[range]);
            rows.extend(block.rows.clone());
        }
        if target.is_empty() {
            return Fitted { dipole: *dipole, glrt: 0.0, left: 0.0 };
        }
        let (glrt, amplitudes, _) = solve(&columns, &target);
        let left = |k: usize| target[k] - (0..3).map(|i| columns[i][k] * amplitudes[i]).sum::<f64>();
        let own_s = OWN_DISTANCES * dipole.distance_s;
        let own: Vec<f64> = (0..target.len())
            .filter(|&k| (epochs_s[rows[k]] - dipole.epoch_s).abs() <= own_s)
            .map(|k| left(k).powi(2))
            .collect();
        let left = own.iter().sum::<f64>() / own.len().max(1) as f64;
        Fitted { dipole: *dipole, glrt, left }
    }
}
