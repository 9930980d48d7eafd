//! Whether the fluxgate has what the scalar has: the magnitude of its vector holds the field, too.

use super::dipole::{Dipole, Reached};
use super::trimmed::trimmed;
use crate::diagnosis::base::filled;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::projection::{Projection, dot};
use crate::simulator::signals::Signals;

/// The magnitude of the fluxgate vector without the slow background, and without what its own errors may make of it.
pub(super) struct Magnitude<'b> {
    whitening: Whitening,
    epochs_s: &'b [f64],
    /// nT over the noise.
    residual: Vec<f64>,
    noise_nt: f64,
}

/// What the fluxgate says of an anomaly of the scalar.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Size of the anomaly in the fluxgate over that in the scalar.
    pub(super) ratio: f64,
    /// How many standard deviations the anomaly is in the fluxgate, if it is there.
    pub(super) strength: f64,
}

impl<'b> Magnitude<'b> {
    /// `blocks` gives the blocks of some usable rows. The fluxgate's errors are fitted to the rows that do not stand out.
    pub(super) fn of(
        table: &Prepared,
        signals: &'b Signals,
        usable: &[bool],
        blocks: impl Fn(&[bool]) -> Vec<Block>,
    ) -> Self {
        let magnitude = filled(&table.magnitudes_nt());
        let errors = of_errors(&signals.rows().direction);
        let fitted = |blocks: &[Block]| {
            let whitening = Whitening::new(blocks, Predictor::white(1.0), None);
            let whitened: Vec<Vec<f64>> = errors.iter().map(|column| whitening.apply(column)).collect();
            let sizes = Projection::of(&whitened).solve(&whitening.apply(&magnitude));
            let mut left = magnitude.clone();
            for (column, size) in errors.iter().zip(&sizes) {
                left.iter_mut().zip(column).for_each(|(left, x)| *left -= size * x);
            }
            ((), left)
        };
        let ((), left) = trimmed(usable, &blocks, fitted);
        let whitening = Whitening::new(&blocks(usable), Predictor::white(1.0), None);
        let mut residual = whitening.apply(&left);
        let noise_nt = robust_mean_square(&residual).sqrt().max(f64::MIN_POSITIVE);
        residual.iter_mut().for_each(|nt| *nt /= noise_nt);
        Self { whitening, epochs_s: signals.epochs_s(), residual, noise_nt }
    }

    /// What it says of a dipole of the scalar.
    pub(super) fn seen(&self, dipole: &Dipole) -> Seen {
        let (mut along, mut own) = (0.0, 0.0);
        for Reached { index, rows, samples } in dipole.reached(&self.whitening, self.epochs_s) {
            let anomaly = self.epochs_s[rows].iter().map(|s| dipole.anomaly_nt(*s) / self.noise_nt);
            let anomaly = self.whitening.apply_block(index, &anomaly.collect::<Vec<f64>>());
            along += dot(&anomaly, &self.residual[samples]);
            own += dot(&anomaly, &anomaly);
        }
        Seen { ratio: along / own.max(f64::MIN_POSITIVE), strength: own.sqrt() }
    }
}

/// What bias, scales, skewed axes and a cubic error of each make of the magnitude: polynomials of the direction.
fn of_errors(directions: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let column = |of: &dyn Fn(&[f64; 3]) -> f64| directions.iter().map(of).collect::<Vec<f64>>();
    let mut columns: Vec<Vec<f64>> = (0..3).map(|i| column(&|c| c[i])).collect();
    columns.extend((0..3).flat_map(|i| (i..3).map(move |j| (i, j))).map(|(i, j)| column(&|c| c[i] * c[j])));
    columns.push(column(&|c| c.iter().map(|c| c.powi(4)).sum()));
    columns
}
