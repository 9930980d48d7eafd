//! Recursive least squares.

use super::Prior;
use super::elastic_net::ElasticNet;
use super::estimator::Estimator;
use super::recursion::RecursiveState;
use crate::model::{Row, TermVector};

/// Recursive least squares with forgetting: eqs. (16), (17) without dual and without renewed penalty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rls {
    sqrt_forgetting: f32,
    weights: TermVector,
}

impl Rls {
    /// `forgetting` per epoch, above 0 and at most 1; `lambda2` in the units of eq. (7): `P_0 = I / lambda2`.
    pub fn new(forgetting: f64, lambda2: f64) -> Self {
        let penalty = ElasticNet { lambda1: 0.0, lambda2 };
        Self { sqrt_forgetting: libm::sqrt(forgetting) as f32, weights: penalty.scaled_lambda2() }
    }
}

impl Estimator for Rls {
    type State = RecursiveState;

    const IDLE: RecursiveState = RecursiveState::IDLE;

    fn start(&self, state: &mut RecursiveState, prior: &Prior) {
        *state = RecursiveState::start(&self.weights, prior.coefficients);
    }

    fn update(&self, state: &mut RecursiveState, row: &Row) {
        state.factor.forget(self.sqrt_forgetting);
        state.factor.add(row);
        state.solve();
    }
}
