//! Whether a few large values are all that a candidate has for it: noise with heavy tails has such, and a moment or a period can be
//! found that meets them.

use super::state::State;
use crate::diagnosis::regression::problem::{Fit, solve};
use crate::diagnosis::search::{Candidate, log_tail};

impl State<'_> {
    /// Logarithm of the chance of a candidate that is not in the fit, were every value of the residual as large as a normal one of the
    /// same rank in its tails.
    pub(super) fn log_p_without_tails(&self, candidate: &Candidate) -> f64 {
        let (glrt, _, _) = solve(&self.projected(candidate, &self.fit), self.without_tails());
        log_tail(candidate.dof, glrt) + candidate.trials_factor.ln()
    }

    /// The columns of a candidate that is not random, whitened, all of a fit projected out.
    pub(super) fn projected(&self, candidate: &Candidate, fit: &Fit) -> Vec<Vec<f64>> {
        let own = candidate.term.regressors(self.problem.library, &self.problem.signals);
        let own =
            if own.is_empty() { vec![candidate.term.column(self.problem.library, &self.problem.signals)] } else { own };
        self.problem.projected(&own, &fit.projection)
    }
}
