//! Parameters that act at whole rows and must be tried out: moments and the edges of pulses.

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::Projection;
use crate::diagnosis::regression::term::Term;

/// Steps of parameters that are tried end here, of the smallest useful one: many edges together tell parts of a row.
const FINEST: f64 = 0.12;

impl RegressionProblem<'_> {
    /// A joint fit, and once more with the tried parameters of one of its terms at their best, if that leaves less.
    pub(crate) fn fit_tried(&self, terms: &[Term], index: usize, widest: f64) -> Fit {
        let fit = self.fit(terms);
        let term = &terms[index];
        if term.discrete_steps(self.library, self.duration_s()).is_empty() {
            return fit;
        }
        let mut terms = fit.terms.clone();
        terms[index] = self.tried(&fit, index, widest);
        let again = self.fit(&terms);
        if again.sse() < fit.sse() { again } else { fit }
    }

    /// Try out the parameters of a term that act at whole rows, by halving steps, the other terms' directions swept out.
    /// Returns the term at its best and what it explains then.
    pub(crate) fn tried(&self, fit: &Fit, index: usize, widest: f64) -> Term {
        let mut term = fit.terms[index].clone();
        let effect = &self.library[term.effect];
        if term.discrete_steps(self.library, self.duration_s()).is_empty() {
            return term;
        }
        let others = fit.others(index);
        let sensitivity = self.sensitivity(&others, &self.signals, &fit.coefficients);
        let (projection, _) = self.projection_of(&others, &self.signals, &sensitivity);
        let target = self.left_without(fit, index, &projection);
        let mut glrt = self.glrt(&mut term, &projection, &target);
        let mut scale = widest;
        while scale > FINEST {
            let mut better = false;
            for at in effect.neighbours(&term.at, self.duration_s(), scale) {
                let mut other = Term { at, ..term.clone() };
                let other_gain = self.glrt(&mut other, &projection, &target);
                if other_gain > glrt + 1e-9 {
                    (term, glrt, better) = (other, other_gain, true);
                }
            }
            if !better {
                scale *= 0.5;
            }
        }
        term
    }

    /// What a fit leaves without one of its terms, the directions of the others swept out.
    fn left_without(&self, fit: &Fit, index: usize, others: &Projection) -> Vec<f64> {
        let mut columns = fit.columns.clone();
        columns.remove(index);
        let mut left = self.whitening.apply(&self.residual(&fit.coefficients, &columns));
        others.project_out(&mut left);
        left
    }

    /// How far each tried parameter of a term can move before it explains `less` less, everything linear fitted again.
    pub(crate) fn limits(&self, fit: &Fit, index: usize, less: f64) -> Vec<(usize, [f64; 2])> {
        let term = &fit.terms[index];
        let effect = &self.library[term.effect];
        let steps = term.discrete_steps(self.library, self.duration_s());
        if steps.is_empty() {
            return Vec::new();
        }
        let projection = self.fit_held(fit, index);
        let target = self.left_without(fit, index, &projection);
        let best = self.glrt(&mut term.clone(), &projection, &target);
        let side = |parameter: usize, step: f64| {
            let mut by = step;
            for _ in 0..10 {
                let mut other = term.clone();
                other.at = effect.moved(&term.at, parameter, by, self.duration_s());
                if self.glrt(&mut other, &projection, &target) < best - less {
                    break;
                }
                by *= 1.6;
            }
            term.at[parameter] + by
        };
        steps
            .into_iter()
            .map(|(parameter, step)| (parameter, [side(parameter, -step), side(parameter, step)]))
            .collect()
    }
}
