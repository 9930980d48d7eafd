//! Any effect of which nothing is known but the ranges of its parameters, as those that users write: points all over the
//! nonlinear ones, of which the best are followed uphill.

use rayon::prelude::*;

use super::Candidate;
use crate::diagnosis::policy::{RANGE_CLIMBED, RANGE_HALVINGS, RANGE_POINTS, RANGE_POINTS_OF_ONE, RANGE_WIDE_RATIO};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::regression::term::Term;
use crate::effects::{Kind, Parameter};

pub(super) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let parameters = problem.library[effect].spec().parameters;
    let searched: Vec<usize> = (0..parameters.len()).filter(|&index| parameters[index].kind != Kind::Linear).collect();
    let place = Place { problem, fit, effect, searched: &searched };
    let points = points(searched.len());
    let mut tried: Vec<(f64, Vec<f64>)> =
        points.par_iter().map(|point| (place.term(point).0, point.clone())).filter(|(glrt, _)| *glrt > 0.0).collect();
    tried.sort_by(|a, b| b.0.total_cmp(&a.0));
    let spacing = (points.len() as f64).powf(-1.0 / searched.len().max(1) as f64);
    let starts = apart(tried, 2.0 * spacing);
    let climbed = starts.into_par_iter().map(|start| place.climbed(start, 0.5 * spacing));
    let (_, point) = climbed.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (glrt, term) = place.term(&point);
    let dof = (searched.len() + term.coordinates.len()).max(1) as f64;
    Some(Candidate { term, glrt, dof, trials_factor: points.len() as f64, variance: None })
}

/// The best ones, none near another one.
fn apart(tried: Vec<(f64, Vec<f64>)>, least: f64) -> Vec<(f64, Vec<f64>)> {
    let mut kept: Vec<(f64, Vec<f64>)> = Vec::new();
    for one in tried {
        let is_near = |other: &(f64, Vec<f64>)| one.1.iter().zip(&other.1).all(|(a, b)| (a - b).abs() < least);
        if !kept.iter().any(is_near) {
            kept.push(one);
        }
        if kept.len() == RANGE_CLIMBED {
            break;
        }
    }
    kept
}

/// Points of the unit cube: evenly along a line, else by the additive recurrence whose steps are powers of the root of
/// `x^(d + 1) = x + 1` (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn points(dimensions: usize) -> Vec<Vec<f64>> {
    match dimensions {
        0 => vec![Vec::new()],
        1 => (0..RANGE_POINTS_OF_ONE).map(|k| vec![(k as f64 + 0.5) / RANGE_POINTS_OF_ONE as f64]).collect(),
        _ => {
            let mut root = 1.5_f64;
            (0..40).for_each(|_| root = (1.0 + root).powf(1.0 / (dimensions + 1) as f64));
            let step: Vec<f64> = (1..=dimensions).map(|k| root.powi(-(k as i32))).collect();
            let point = |k: usize| step.iter().map(|step| (0.5 + step * (k + 1) as f64).fract()).collect();
            (0..RANGE_POINTS).map(point).collect()
        }
    }
}

/// Where an effect is looked for.
struct Place<'a> {
    problem: &'a RegressionProblem<'a>,
    fit: &'a Fit,
    effect: usize,
    searched: &'a [usize],
}

impl Place<'_> {
    /// What is explained at a point of the unit cube, and the term there.
    fn term(&self, point: &[f64]) -> (f64, Term) {
        let parameters = self.problem.library[self.effect].spec().parameters;
        let mut at = vec![0.0; parameters.len()];
        self.searched.iter().zip(point).for_each(|(&index, &share)| at[index] = value(&parameters[index], share));
        let mut term = Term { effect: self.effect, at, coordinates: Vec::new() };
        if parameters.len() > self.searched.len() {
            let glrt = self.problem.glrt(&mut term, &self.fit.projection, &self.fit.residual_whitened);
            return (glrt, term);
        }
        // The coefficients give way once it is fitted with them, so the size counts less than the shape.
        let mut column = self.problem.whitening.apply(&term.column(self.problem.library, &self.problem.signals));
        self.fit.projection.project_out(&mut column);
        let (along, own) = (dot(&column, &self.fit.residual_whitened), dot(&column, &column));
        (if along > 0.0 && own > 0.0 { along * along / own } else { 0.0 }, term)
    }

    /// To the best of the neighbours along each axis as long as that is better, then with half the step.
    fn climbed(&self, (mut most, mut at): (f64, Vec<f64>), mut step: f64) -> (f64, Vec<f64>) {
        for _ in 0..RANGE_HALVINGS {
            loop {
                let neighbours = (0..at.len()).flat_map(|axis| [(axis, step), (axis, -step)]);
                let moved = neighbours.map(|(axis, by)| {
                    let mut moved = at.clone();
                    moved[axis] = (moved[axis] + by).clamp(0.0, 1.0);
                    (self.term(&moved).0, moved)
                });
                match moved.max_by(|a, b| a.0.total_cmp(&b.0)) {
                    Some((better, moved)) if better > most * (1.0 + 1e-9) => (most, at) = (better, moved),
                    _ => break,
                }
            }
            step *= 0.5;
        }
        (most, at)
    }
}

/// A value within a range, evenly, or by ratio where a range of positive values is wide.
fn value(parameter: &Parameter, share: f64) -> f64 {
    let [low, high] = parameter.plausible;
    match low > 0.0 && high > RANGE_WIDE_RATIO * low {
        true => low * (high / low).powf(share),
        false => low + share * (high - low),
    }
}
