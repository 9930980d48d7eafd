//! Batch elastic net, eq. (7), on the accumulated information factor: no stored samples.

use super::square_root_information::SquareRootInformation;
use crate::model::basis::{dual_from_terms, gradient_to_terms, partner, set_zero, to_terms};
use crate::model::{Coefficients, NT_PER_UNIT, TERMS, TermVector, ZEROS};
use crate::policy::GRADIENT_TOLERANCE;

/// Weights of eq. (7), in its units: coefficients in nT, nT/nT and s. Immutable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticNet {
    /// Weight of the sum of magnitudes, `lambda1` >= 0.
    pub lambda1: f64,
    /// Weight of half the sum of squares, `lambda2` >= 0.
    pub lambda2: f64,
}

impl Default for ElasticNet {
    /// The published weights, section 3.1: 0.001 and 0.025.
    fn default() -> Self {
        Self { lambda1: 0.001, lambda2: 0.025 }
    }
}

/// Sign changes that the search may take; it needs one or two per coefficient that ends at zero.
const MAX_SIGN_CHANGES: usize = 200;

impl ElasticNet {
    /// `lambda1` per scaled term, nT^2 per nT.
    pub(super) fn scaled_lambda1(&self) -> TermVector {
        TermVector::from_fn(|i, _| (self.lambda1 / NT_PER_UNIT[i]) as f32)
    }

    /// `lambda2` per scaled term.
    pub(super) fn scaled_lambda2(&self) -> TermVector {
        TermVector::from_fn(|i, _| (self.lambda2 / (NT_PER_UNIT[i] * NT_PER_UNIT[i])) as f32)
    }

    /// The data's factor with the ridge part of the penalty added.
    pub(super) fn penalised(&self, data: &SquareRootInformation) -> SquareRootInformation {
        let mut penalised = data.clone();
        for (term, weight) in self.scaled_lambda2().iter().enumerate() {
            penalised.add_penalty(term, *weight);
        }
        penalised
    }

    /// The coefficients that minimise eq. (7) for the observations in `data`.
    ///
    /// Feature-sign search (Lee, Battle, Raina, Ng, "Efficient sparse coding algorithms", NIPS 2006, algorithm 1):
    /// guess the signs, solve exactly for them, move there or to the best sign change on the way. `None` when the
    /// result is not finite.
    pub fn solve(&self, data: &SquareRootInformation) -> Option<Coefficients> {
        let search = Search { factor: self.penalised(data), bound: self.scaled_lambda1() };
        search.run()
    }

    /// The coefficients of the ridge part alone, lambda1 = 0. `None` when they are not finite.
    pub(super) fn ridge(&self, data: &SquareRootInformation) -> Option<Coefficients> {
        Coefficients::from_basis(self.penalised(data).solve(&ZEROS))
    }
}

/// The problem `min |s - R theta|^2 / 2 + sum bound_i |beta_i|`, `beta = T theta`.
struct Search {
    factor: SquareRootInformation,
    bound: TermVector,
}

impl Search {
    fn run(&self) -> Option<Coefficients> {
        let mut now = Coefficients::from_basis(self.factor.solve(&ZEROS))?;
        let mut signs = signs_of(&now);
        for _ in 0..MAX_SIGN_CHANGES {
            let target = Coefficients::from_basis(self.solve_for(&signs))?;
            let consistent = signs_of(&target).iter().zip(&signs).all(|(target, sign)| target * sign >= 0.0);
            now = if consistent { target } else { self.line_search(now.basis(), &target)? };
            signs = signs_of(&now);
            if consistent {
                match self.worst_violation(&now) {
                    Some((term, sign)) => signs[term] = sign,
                    None => break,
                }
            }
        }
        Some(now)
    }

    /// The minimum over the terms with a sign, as if the signs were right.
    fn solve_for(&self, signs: &TermVector) -> TermVector {
        let active: [bool; TERMS] = core::array::from_fn(|i| signs[i] != 0.0);
        let dual = self.bound.component_mul(signs);
        let mut theta = self.factor.restricted(&active).solve(&dual_from_terms(&dual));
        // A diagonal term that is fixed at zero is minus the sum in this basis.
        for term in (0..TERMS).filter(|&term| !active[term] && partner(term).is_some()) {
            set_zero(&mut theta, term);
        }
        theta
    }

    /// Of the coefficients at zero the one that violates the conditions of the minimum most, its gradient exceeding its
    /// bound, and the sign that it should take.
    fn worst_violation(&self, now: &Coefficients) -> Option<(usize, f32)> {
        let signs = signs_of(now);
        let gradient = gradient_to_terms(&self.factor.transpose_times(&self.factor.residual_vector(now)));
        let excess = |i: usize| libm::fabsf(gradient[i]) - self.bound[i] * (1.0 + GRADIENT_TOLERANCE);
        (0..TERMS)
            .filter(|&i| signs[i] == 0.0 && excess(i) > 0.0)
            .max_by(|&i, &j| excess(i).total_cmp(&excess(j)))
            .map(|i| (i, sign(gradient[i])))
    }

    /// The best of the target and of the points on the way to it where a coefficient changes sign (and is zero).
    fn line_search(&self, from: &TermVector, target: &Coefficients) -> Option<Coefficients> {
        let (from_beta, target_beta) = (to_terms(from), to_terms(target.basis()));
        let mut best = *target;
        let mut least = self.objective(target);
        for crossing in (0..TERMS).filter(|&i| from_beta[i] * target_beta[i] < 0.0) {
            let share = from_beta[crossing] / (from_beta[crossing] - target_beta[crossing]);
            let mut point = from + (target.basis() - from) * share;
            set_zero(&mut point, crossing);
            let point = Coefficients::from_basis(point)?;
            let objective = self.objective(&point);
            if objective < least {
                (best, least) = (point, objective);
            }
        }
        Some(best)
    }

    fn objective(&self, at: &Coefficients) -> f32 {
        let fit = self.factor.residual_vector(at).norm_squared();
        let size = to_terms(at.basis()).map(libm::fabsf).dot(&self.bound);
        fit / 2.0 + size
    }
}

fn signs_of(coefficients: &Coefficients) -> TermVector {
    to_terms(coefficients.basis()).map(sign)
}

/// -1, 0 or 1; `f32::signum` has no zero.
fn sign(value: f32) -> f32 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}
