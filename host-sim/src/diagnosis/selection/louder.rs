//! How surely the noise is louder where a random effect would make it so.

use super::state::State;
use crate::diagnosis::evidence::accounted::left_before;
use crate::diagnosis::noise::louder::Differences;
use crate::diagnosis::noise::variance::VarianceFit;
use crate::diagnosis::policy::{CONE_LEAST_RANKS_GLRT, SMOOTH_MOST};
use crate::diagnosis::search::{Candidate, monomials};
use crate::effects::Search;

/// Orders of the products of the direction's components of which a smooth function of it is made.
const SMOOTH_ORDERS: [i32; 2] = [1, 2];

impl State<'_> {
    /// GLRT of an added variance by the ranks of what is left, beside what the other random effects add and the noise of the direction,
    /// of which it is not known well how loud it is; of a cone 0 where it is rather a smooth function of the direction.
    pub(super) fn louder(&self, candidate: &Candidate, added: &VarianceFit) -> f64 {
        let logs = |growth: &[f64]| growth.iter().map(|growth| growth.ln()).collect();
        let direction = self.noise.direction_growth().map(logs);
        let others = self.random.iter().filter(|other| other.term.effect != candidate.term.effect);
        let others = others.filter_map(|other| other.variance.as_ref().map(VarianceFit::log_growth));
        let differences = Differences::of(&left_before(&self.left()), direction.into_iter().chain(others).collect());
        let own = differences.glrt(added.log_growth());
        // What is no finding anyhow need not be looked at further.
        let is_cone = self.search(candidate) == Search::Cone && own >= CONE_LEAST_RANKS_GLRT;
        if is_cone && self.is_smooth(&differences, added.log_growth()) { 0.0 } else { own }
    }

    /// Whether the loudness is a smooth function of the direction rather than a growth, given by its logarithm: of what has an edge the
    /// growth says all, and a smooth function beside it next to nothing.
    fn is_smooth(&self, differences: &Differences, growth: Vec<f64>) -> bool {
        let smooth = self.smooth_functions();
        let parameters = smooth.len() as f64;
        let of_noise = differences.deviance_of(Vec::new());
        let own = differences.deviance_of(vec![growth.clone()]);
        let both = differences.deviance_of(smooth.into_iter().chain([growth]).collect());
        own - both > parameters + SMOOTH_MOST * (of_noise - own)
    }

    /// Of the direction, one value a sample each.
    fn smooth_functions(&self) -> Vec<Vec<f64>> {
        let direction = &self.problem.signals.rows().direction;
        let directions: Vec<[f64; 3]> = self.problem.whitening.rows().map(|row| direction[row]).collect();
        monomials(&directions, SMOOTH_ORDERS)
    }
}
