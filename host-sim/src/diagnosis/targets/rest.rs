//! What a fit leaves of the scalar, as targets are looked for in it.

use std::sync::Arc;

use super::trimmed::trimmed;
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::{NoiseInput, NoiseModel};
use crate::diagnosis::noise::motion::MotionSpan;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::effects::{Channel, Library};
use crate::simulator::signals::Signals;

/// What a fit leaves of the scalar.
pub(crate) struct Rest {
    pub(super) whitening: Arc<Whitening>,
    /// One a row, nT.
    pub(super) residual_nt: Vec<f64>,
    /// One a sample.
    pub(super) whitened: Vec<f64>,
    /// Rms of the noise, nT.
    pub(super) noise_nt: f64,
}

impl Rest {
    /// Of a fit with effects.
    pub(crate) fn of(problem: &RegressionProblem<'_>, fit: &Fit) -> Self {
        let residual_nt = problem.residual_nt(fit);
        let noise = noise(problem.whitening.blocks(), &residual_nt, &problem.signals);
        Self {
            whitening: Arc::clone(&problem.whitening),
            whitened: fit.residual_whitened.clone(),
            noise_nt: noise.std_nt().unwrap_or(f64::INFINITY),
            residual_nt,
        }
    }

    /// Of the 18 terms alone, fitted to the rows that do not stand out: few and large targets would bend them. `blocks`
    /// gives the blocks of some usable rows.
    pub(crate) fn of_terms(
        table: &Prepared,
        signals: &Signals,
        library: &Library,
        usable: &[bool],
        blocks: impl Fn(&[bool]) -> Vec<Block>,
    ) -> Self {
        let fitted = |blocks: &[Block]| {
            let white = NoiseModel::white(blocks);
            let reading_nt = table.scalar_nt.clone();
            let problem =
                RegressionProblem::new(library, Channel::Scalar, signals.clone(), reading_nt, white.whitening);
            let residual_nt = problem.residual_nt(&problem.fit(&[]));
            (noise(blocks, &residual_nt, signals), residual_nt)
        };
        let (noise, residual_nt) = trimmed(usable, &blocks, fitted);
        let whitening = Whitening::new(&blocks(usable), noise.whitening.predictor().clone(), None);
        Self {
            whitened: whitening.apply(&residual_nt),
            whitening: Arc::new(whitening),
            noise_nt: noise.std_nt().unwrap_or(f64::INFINITY),
            residual_nt,
        }
    }
}

fn noise(blocks: &[Block], residual_nt: &[f64], signals: &Signals) -> NoiseModel {
    // What effects leave that are not known yet is noise to a target.
    let motion = &MotionSpan::none(blocks);
    let input = NoiseInput { residual_nt, motion, signals, direction_noise_rad: None, random_nt2: &[] };
    NoiseModel::white(blocks).estimate(&input)
}
