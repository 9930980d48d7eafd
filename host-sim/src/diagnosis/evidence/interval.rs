//! Parameters of an effect with their 95 % intervals.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;

use crate::diagnosis::evidence::jackknife;
use crate::diagnosis::policy::{INFLATION, NOT_IDENTIFIED};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::selection::Accepted;
use crate::effects::{Domain, Kind, Library, Parameter};

/// Draws of the parameters.
const DRAWS: usize = 800;
/// Half of a step between rows, and what a time is written with, s.
const BETWEEN_ROWS_S: f64 = 0.051;
/// Half of the 95 % range of a normal variable.
pub(crate) const TWO_SIGMA: f64 = 1.96;

/// A parameter as it was found.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterEstimate {
    /// Its name, with its unit.
    pub name: String,
    /// Its value; none where the recording does not tell.
    pub value: Option<f64>,
    /// 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ci95: Option<[f64; 2]>,
}

/// Parameters of an additive term of a fit, for noise of this variance; beside a rest that is no noise, from what is left in each block
/// where that says more.
pub(crate) fn of_term(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    index: usize,
    (variance, is_beside_rest): (f64, bool),
    draw: &mut ChaCha8Rng,
) -> Vec<ParameterEstimate> {
    let term = &fit.terms[index];
    let library = problem.library;
    let spec = library[term.effect].spec();
    let effect = &library[term.effect];
    let best = effect.canonical(term.parameters(library));
    let smooth = term.derivative_steps(library, problem.duration_s());
    let (covariance, widest) = covariance(problem, fit, index, (variance, is_beside_rest));
    // Nothing varies smoothly in an effect that acts by whole samples at whole rows.
    let eigen = (!covariance.is_empty()).then(|| SymmetricEigen::new(covariance));
    let mut drawn: Vec<Vec<f64>> = vec![Vec::with_capacity(DRAWS); best.len()];
    for _ in 0..DRAWS {
        let Some(eigen) = &eigen else { break };
        let unit = DVector::from_fn(eigen.eigenvalues.len(), |k, _| {
            let normal: f64 = StandardNormal.sample(draw);
            normal * eigen.eigenvalues[k].max(0.0).sqrt()
        });
        let off = &eigen.eigenvectors * unit;
        let mut other = term.clone();
        for (k, coordinate) in other.coordinates.iter_mut().enumerate() {
            *coordinate += off[k];
        }
        for (k, (parameter, _)) in smooth.iter().enumerate() {
            other.at[*parameter] += off[term.coordinates.len() + k];
        }
        let parameters = effect.canonical(other.parameters(library));
        for (k, value) in parameters.into_iter().enumerate() {
            drawn[k].push(near(spec.parameters[k].domain, value, best[k]));
        }
    }
    let mut limits = problem.limits(fit, index, 3.84 * variance * (INFLATION * widest).powi(2));
    // What acts between two rows does so anywhere between them.
    let moments = limits.iter_mut().filter(|(index, _)| spec.parameters[*index].domain == Domain::Moment);
    moments.for_each(|(_, [low, high])| (*low, *high) = (*low - BETWEEN_ROWS_S, *high + BETWEEN_ROWS_S));
    let estimate = |k: usize| {
        let limits = limits.iter().find(|(parameter, _)| *parameter == k).map(|(_, limits)| *limits);
        let ci95 = limits.unwrap_or_else(|| middle_of(&mut drawn[k].clone(), best[k]));
        identified(&spec.parameters[k], best[k], ci95)
    };
    (0..best.len()).map(estimate).collect()
}

/// Covariance of the parameters of a term, coordinates, then smooth ones; and how many times the error of any of them is that of noise.
fn covariance(
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    index: usize,
    (variance, is_beside_rest): (f64, bool),
) -> (DMatrix<f64>, f64) {
    let own = |covariance: DMatrix<f64>| problem.own_covariance(&covariance, fit, index) * INFLATION * INFLATION;
    let of_noise = own(fit.projection.covariance() * variance);
    if !is_beside_rest {
        return (of_noise, 1.0);
    }
    let wider = wider_by(&of_noise, &own(jackknife::covariance(problem, fit)));
    let covariance = DMatrix::from_fn(wider.len(), wider.len(), |i, j| of_noise[(i, j)] * wider[i] * wider[j]);
    (covariance, wider.iter().copied().fold(1.0, f64::max))
}

/// How many times each standard deviation of a covariance is that of another one, where the other is larger.
fn wider_by(covariance: &DMatrix<f64>, other: &DMatrix<f64>) -> DVector<f64> {
    let ratio = |k: usize| (other[(k, k)] / covariance[(k, k)].max(f64::MIN_POSITIVE)).max(1.0).sqrt();
    DVector::from_fn(covariance.nrows(), |k, _| ratio(k))
}

/// Parameters of an effect that is random; the standard error of the logarithm of its variance is known, and where the likely cones end.
pub(crate) fn of_random(library: &Library, accepted: &Accepted) -> Vec<ParameterEstimate> {
    let Accepted { candidate, reach, .. } = accepted;
    let spec = library[candidate.term.effect].spec();
    let log_error = 0.5 * candidate.variance.as_ref().map_or(1.0, |variance| variance.log_error);
    let range = |k: usize, value: f64| match spec.parameters[k].kind {
        Kind::Spread => Some([value * (-TWO_SIGMA * log_error).exp(), value * (TWO_SIGMA * log_error).exp()]),
        _ => reach.map(|reach| reach.range[k]),
    };
    let values = candidate.term.at.iter().enumerate();
    let estimate = |(k, &value): (usize, &f64)| ParameterEstimate {
        name: spec.parameters[k].name.into(),
        value: Some(value),
        ci95: range(k, value),
    };
    values.map(estimate).collect()
}

/// Wilson's interval of a share.
pub(crate) fn wilson(share: f64, samples: f64) -> [f64; 2] {
    let z2 = TWO_SIGMA * TWO_SIGMA;
    let middle = share + 0.5 * z2 / samples;
    let half = TWO_SIGMA * (share * (1.0 - share) / samples + 0.25 * z2 / (samples * samples)).sqrt();
    let [low, high] = [middle - half, middle + half].map(|end| end / (1.0 + z2 / samples));
    // Of all or none it ends at the share, but for rounding.
    [low.max(0.0).min(share), high.min(1.0).max(share)]
}

/// A cyclic value on the turn of another one.
fn near(domain: Domain, value: f64, other: f64) -> f64 {
    match domain {
        Domain::Cyclic { turn } => value - turn * ((value - other) / turn).round(),
        _ => value,
    }
}

fn middle_of(values: &mut [f64], best: f64) -> [f64; 2] {
    if values.is_empty() {
        return [best, best];
    }
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    [at(0.025).min(best), at(0.975).max(best)]
}

fn identified(parameter: &Parameter, value: f64, ci95: [f64; 2]) -> ParameterEstimate {
    let plausible = parameter.plausible[1] - parameter.plausible[0];
    let is_unknown =
        !value.is_finite() || !ci95.iter().all(|end| end.is_finite()) || ci95[1] - ci95[0] > NOT_IDENTIFIED * plausible;
    let name = parameter.name.into();
    if is_unknown && parameter.domain != Domain::Moment {
        return ParameterEstimate { name, value: None, ci95: None };
    }
    ParameterEstimate { name, value: Some(value), ci95: Some(ci95) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_lies_in_its_interval() {
        for samples in 1..4_000 {
            for share in [0.0, 0.5, 1.0] {
                let [low, high] = wilson(share, f64::from(samples));
                assert!(0.0 <= low && low <= share && share <= high && high <= 1.0, "{share} of {samples}");
            }
        }
        // 0 of 20, by Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3.
        assert!((wilson(0.0, 20.0)[1] - 0.1611).abs() < 1e-3);
    }
}
