//! Batch elastic net, eq. (7), on the accumulated information factor: no stored samples.

use super::factor::InformationFactor;
use super::{Coefficients, NT_PER_UNIT, TERMS, TermVector};

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
const LONGEST_SEARCH: usize = 200;

/// How far beyond `lambda1` a gradient may lie before its coefficient must leave zero: f32 knows it no better.
const GRADIENT_TOLERANCE: f32 = 1e-3;

impl ElasticNet {
    /// `lambda1` per scaled column, nT^2 per nT.
    pub(super) fn scaled_lambda1(&self) -> TermVector {
        core::array::from_fn(|i| (self.lambda1 / NT_PER_UNIT[i]) as f32)
    }

    /// `lambda2` per scaled column.
    pub(super) fn scaled_lambda2(&self) -> TermVector {
        core::array::from_fn(|i| (self.lambda2 / (NT_PER_UNIT[i] * NT_PER_UNIT[i])) as f32)
    }

    /// The data's factor with the ridge part of the penalty added.
    pub(super) fn penalised(&self, data: &InformationFactor) -> InformationFactor {
        let mut penalised = data.clone();
        for (term, weight) in self.scaled_lambda2().into_iter().enumerate() {
            penalised.add_penalty(term, weight);
        }
        penalised
    }

    /// The coefficients that minimise eq. (7) for the observations in `data`.
    ///
    /// Feature-sign search (Lee, Battle, Raina, Ng, "Efficient sparse coding algorithms", NIPS 2006, algorithm 1):
    /// guess the signs, solve exactly for them, move there or to the best sign change on the way. `None` when the
    /// result is not finite.
    pub fn solve(&self, data: &InformationFactor) -> Option<Coefficients> {
        let search = Search { factor: self.penalised(data), bound: self.scaled_lambda1() };
        Coefficients::from_scaled(search.run())
    }
}

/// The problem `min |s - R b|^2 / 2 + sum bound_i |b_i|`.
struct Search {
    factor: InformationFactor,
    bound: TermVector,
}

impl Search {
    fn run(&self) -> TermVector {
        let mut b = self.factor.solve(&[0.0; TERMS]);
        let mut signs = b.map(sign);
        for _ in 0..LONGEST_SEARCH {
            let target = self.solve_for(&signs);
            let consistent = target.iter().zip(&signs).all(|(target, sign)| target * sign >= 0.0);
            if consistent {
                b = target;
                signs = b.map(sign);
                match self.most_wrongly_zero(&b) {
                    Some((term, sign)) => signs[term] = sign,
                    None => return b,
                }
            } else {
                b = self.best_between(&b, &target);
                signs = b.map(sign);
            }
        }
        b
    }

    /// The minimum over the terms with a sign, as if the signs were right.
    fn solve_for(&self, signs: &TermVector) -> TermVector {
        let active = signs.map(|sign| sign != 0.0);
        let dual = core::array::from_fn(|i| self.bound[i] * signs[i]);
        self.factor.restricted(&active).solve(&dual)
    }

    /// The zero coefficient whose gradient exceeds its bound most, and the sign that it should take.
    fn most_wrongly_zero(&self, b: &TermVector) -> Option<(usize, f32)> {
        let gradient = self.factor.transpose_times(&self.factor.misfit(b));
        let excess = |i: usize| libm::fabsf(gradient[i]) - self.bound[i] * (1.0 + GRADIENT_TOLERANCE);
        (0..TERMS)
            .filter(|&i| b[i] == 0.0 && excess(i) > 0.0)
            .max_by(|&i, &j| excess(i).total_cmp(&excess(j)))
            .map(|i| (i, sign(gradient[i])))
    }

    /// The best of the target and of the points on the way to it where a coefficient changes sign (and is zero).
    fn best_between(&self, from: &TermVector, target: &TermVector) -> TermVector {
        let mut best = *target;
        let mut least = self.objective(target);
        for crossing in 0..TERMS {
            if from[crossing] * target[crossing] >= 0.0 {
                continue;
            }
            let share = from[crossing] / (from[crossing] - target[crossing]);
            let mut point: TermVector = core::array::from_fn(|i| from[i] + share * (target[i] - from[i]));
            point[crossing] = 0.0;
            let objective = self.objective(&point);
            if objective < least {
                (best, least) = (point, objective);
            }
        }
        best
    }

    fn objective(&self, b: &TermVector) -> f32 {
        let fit: f32 = self.factor.misfit(b).iter().map(|rest| rest * rest).sum();
        let size: f32 = b.iter().zip(&self.bound).map(|(b, bound)| bound * libm::fabsf(*b)).sum();
        fit / 2.0 + size
    }
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
