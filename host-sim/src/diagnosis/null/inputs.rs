//! Whether a recorded input drives the residual, in whatever shape: no effect is known here, but the families of shapes by which what has
//! no name is described.

use rayon::prelude::*;

use super::finding::Finding;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::shapes::group::{Group, net_gain};
use crate::diagnosis::shapes::inputs::groups_but_reading;
use crate::diagnosis::shapes::scene::Scene;

/// Of a whitened residual `z` of variance 1, by all inputs but the reading: where the body is jerked, what the direction has wrong between
/// the rows is a shape of the reading's slope. A family makes it likelier by some factor, its size a priori free; noise alone gives a factor
/// of `k` once in `k` recordings at most, whatever the family (Markov's inequality), as far as the likeliest size is no better than a size
/// that was known.
pub(super) fn inputs(problem: &RegressionProblem<'_>, fit: &Fit, z: &[f64], scene: &Scene) -> Finding {
    let families = groups_but_reading(scene, problem.channel);
    let tried = families.len().max(1) as f64;
    let gain =
        |family: Vec<Group>| family.iter().filter_map(|group| gain(group, problem, fit, z, scene)).fold(0.0, f64::max);
    let best = families.into_par_iter().map(gain).reduce(|| 0.0, f64::max);
    // As a chi-squared that makes a residual as much likelier.
    Finding { what: "inputs", log_p: (tried.ln() - best).min(0.0), excess: 2.0 * best }
}

/// Logarithm of how much likelier a group makes the residual, beyond what it makes of it turned round in time: where the model of the noise
/// has its colour wrong, that is more than nothing.
fn gain(group: &Group, problem: &RegressionProblem<'_>, fit: &Fit, z: &[f64], scene: &Scene) -> Option<f64> {
    let (gain, shown, ridge) = group.weighed((problem, &fit.projection), z, scene)?;
    Some(net_gain(gain, shown.gain_by_chance(&ridge, z)))
}
