//! What a fit leaves of a sensor's field, as targets are looked for in it.

use super::nuisance::Nuisance;
use super::trimmed::{Left, trimmed};
use crate::diagnosis::noise::blocks::Block;
use crate::diagnosis::noise::model::{IsNoise, NoiseInput, NoiseModel, predictor_of_all};
use crate::diagnosis::noise::motion::MotionSpan;
use crate::diagnosis::noise::whitening::{Predictor, Whitening};
use crate::diagnosis::policy::{TARGET_CLEAR_SIGMAS, TARGET_MUCH_LEFT};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::effects::{Channel, Library};
use crate::simulator::signals::Signals;

/// What a fit leaves of the scalar, or of the magnitude of the fluxgate vector.
pub(crate) struct Rest {
    /// What makes the noise white, or, where far more is left, all of that.
    pub(super) whitening: Whitening,
    /// One a row, nT.
    pub(super) residual_nt: Vec<f64>,
    /// One a sample.
    pub(super) whitened: Vec<f64>,
    /// Rms of the sensor's noise, nT; not finite where it is not known.
    pub(super) noise_nt: f64,
    /// What was fitted, and may have taken a part of a dipole.
    pub(super) nuisance: Nuisance,
}

impl Rest {
    /// Of a fit with effects; `random_nt2` is what random ones add to the variance of each row.
    pub(crate) fn of(problem: &RegressionProblem<'_>, fit: &Fit, random_nt2: &[Option<Vec<f64>>]) -> Self {
        let residual_nt = problem.residual_nt(fit);
        let blocks = problem.whitening.blocks();
        let noise_nt = noise_nt(&noise(blocks, &residual_nt, &problem.signals, random_nt2));
        let fitted = Columns { columns_nt: &problem.nuisance_columns, is_fitted: &vec![true; residual_nt.len()] };
        match much_left(&residual_nt, blocks, noise_nt) {
            Some(predictor) => {
                let all = NoiseModel::of_predictor(blocks, predictor).with_random(random_nt2);
                Self::beside((*all.whitening).clone(), residual_nt, noise_nt, &fitted)
            }
            None => Self {
                nuisance: Nuisance::of(fitted.columns_nt, &problem.whitening, fitted.is_fitted),
                whitening: (*problem.whitening).clone(),
                whitened: fit.residual_whitened.clone(),
                noise_nt,
                residual_nt,
            },
        }
    }

    /// Of the 18 terms alone, fitted to the rows that do not stand out: few and large targets would bend them. `blocks`
    /// gives the blocks of some usable rows.
    pub(crate) fn of_terms(
        table: &Prepared,
        (signals, direction_noise): (&Signals, &DirectionNoise),
        library: &Library,
        usable: &[bool],
        blocks: impl Fn(&[bool]) -> Vec<Block>,
    ) -> Self {
        let all = blocks(usable);
        let (reading_nt, white) = (table.to_explain_nt(), NoiseModel::white(&all).whitening);
        let problem = RegressionProblem::new(library, Channel::Scalar, signals.clone(), reading_nt, white)
            .holding_terms(table.beyond.held.is_some());
        let left_by = |blocks: &[Block]| {
            let problem = problem.whitened_by(&NoiseModel::white(blocks).whitening);
            let fit = problem.fit(&[]);
            let known_nt2 = direction_noise.variance(signals, &problem.eq4(&fit.coefficients), <[f64]>::to_vec);
            Left { left_nt: problem.residual_nt(&fit), known_nt2, coefficients: fit.coefficients }
        };
        let (fitted, Left { left_nt: residual_nt, coefficients, .. }) = trimmed(usable, &blocks, left_by);
        let noise = noise(&fitted, &residual_nt, signals, &[]);
        let much_left = much_left(&residual_nt, &fitted, noise_nt(&noise));
        let predictor = much_left.unwrap_or_else(|| noise.whitening.predictor().clone());
        let is_fitted = rows_of(&fitted, usable.len());
        let columns = Columns { columns_nt: &problem.nuisance_columns, is_fitted: &is_fitted };
        // Where the noise of the direction is let through, more is no target.
        let even = Whitening::new(&all, predictor, None);
        let known = direction_noise.variance(signals, &problem.eq4(&coefficients), |column| even.apply(column));
        let weights = known.iter().map(|known| 1.0 / (1.0 + known).sqrt()).collect();
        let whitening = Whitening::new(&all, even.predictor().clone(), Some(weights));
        Self::beside(whitening, residual_nt, noise_nt(&noise), &columns)
    }

    /// Of a residual, one a row, nT, what makes it white, and what was fitted; `noise_nt` is not finite where it is not known.
    pub(super) fn beside(whitening: Whitening, residual_nt: Vec<f64>, noise_nt: f64, fitted: &Columns<'_>) -> Self {
        let nuisance = Nuisance::of(fitted.columns_nt, &whitening, fitted.is_fitted);
        Self { whitened: whitening.apply(&residual_nt), whitening, noise_nt, residual_nt, nuisance }
    }

    /// Size from which an anomaly stands out of what is left, nT, where that is much more than noise: there anything may look
    /// like a weak target.
    pub(super) fn clear_nt(&self) -> f64 {
        let std_nt = self.std_nt();
        if std_nt > TARGET_MUCH_LEFT * self.noise_nt { TARGET_CLEAR_SIGMAS * std_nt } else { 0.0 }
    }

    /// Standard deviation of what the whitening makes white, nT.
    pub(super) fn std_nt(&self) -> f64 {
        self.whitening.predictor().std()
    }
}

/// Columns, one value a row, nT, and the rows that they were fitted to.
pub(super) struct Columns<'b> {
    pub(super) columns_nt: &'b [Vec<f64>],
    pub(super) is_fitted: &'b [bool],
}

/// Whether a row is in one of some blocks, and not missing there.
pub(super) fn rows_of(blocks: &[Block], rows: usize) -> Vec<bool> {
    let mut is_there = vec![false; rows];
    for block in blocks {
        is_there[block.rows.clone()].fill(true);
        block.missing.iter().for_each(|at| is_there[block.rows.start + at] = false);
    }
    is_there
}

/// What predicts all that is left, whatever its cause, where that is much more than noise: a target stands out of that.
fn much_left(residual_nt: &[f64], blocks: &[Block], noise_nt: f64) -> Option<Predictor> {
    predictor_of_all(residual_nt, blocks).filter(|all| all.std() > TARGET_MUCH_LEFT * noise_nt)
}

/// Rms of the noise, nT; not finite where it is not known.
fn noise_nt(noise: &NoiseModel) -> f64 {
    noise.std_nt().unwrap_or(f64::INFINITY)
}

fn noise(blocks: &[Block], residual_nt: &[f64], signals: &Signals, random_nt2: &[Option<Vec<f64>>]) -> NoiseModel {
    // What effects leave that are not known yet is noise to a target.
    let motion = &MotionSpan::none(blocks);
    let input = NoiseInput {
        residual_nt,
        motion,
        signals,
        direction_noise: None,
        random_nt2,
        is_noise: IsNoise::OfASensor,
        holds_terms: false,
    };
    NoiseModel::white(blocks).estimate(&input)
}
