//! Whether the fluxgate has what the scalar has: the magnitude of its vector holds the field, too.

use super::dipole::Dipole;
use super::trimmed::trimmed;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::reconstruct::prepared::{Prepared, fill_holes};
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
        let mut magnitude: Vec<f64> =
            table.flux_nt.iter().map(|f| (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]).sqrt()).collect();
        fill_holes(&mut magnitude);
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
        let reach_s = 6.0 * dipole.distance_s;
        let (mut along, mut own) = (0.0, 0.0);
        for (index, (block, range)) in self.whitening.blocks().iter().zip(self.whitening.ranges()).enumerate() {
            let epochs_s = &self.epochs_s[block.rows.clone()];
            if epochs_s[epochs_s.len() - 1] < dipole.epoch_s - reach_s || epochs_s[0] > dipole.epoch_s + reach_s {
                continue;
            }
            let anomaly: Vec<f64> = epochs_s.iter().map(|s| dipole.anomaly_nt(*s) / self.noise_nt).collect();
            let anomaly = self.whitening.apply_block(index, &anomaly);
            along += dot(&anomaly, &self.residual[range]);
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
