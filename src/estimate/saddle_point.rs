//! The published method, as published.

use super::Prior;
use super::elastic_net::ElasticNet;
use super::estimator::Estimator;
use super::recursion::RecursiveState;
use crate::model::basis::to_terms;
use crate::model::{NT_PER_UNIT, Row, TERMS, TermVector};

/// The published method: recursive elastic net by saddle-point optimisation, eqs. (8) to (18).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaddlePoint {
    sqrt_forgetting: f32,
    weights: TermVector,
    renewal: TermVector,
    bound: TermVector,
    step: TermVector,
}

impl SaddlePoint {
    /// Penalties in the units of eq. (7), `forgetting` per epoch (above 0, at most 1), `dual_step` the `nu` of
    /// eq. (14). All are moved into the units of the scaled terms exactly.
    pub fn new(penalty: ElasticNet, forgetting: f64, dual_step: f64) -> Self {
        let renewal = TERMS as f64 * (1.0 - forgetting);
        let scaled = |share: f64| ElasticNet { lambda1: 0.0, lambda2: share * penalty.lambda2 }.scaled_lambda2();
        // Each term's penalty decays from one renewal to the next. This start puts it where it is in that cycle.
        let kept_after = |epochs: usize| core::iter::repeat_n(forgetting, epochs).product::<f64>();
        let just_renewed = if forgetting < 1.0 { renewal / (1.0 - kept_after(TERMS)) } else { 1.0 };
        let start = |term: usize| just_renewed * kept_after(TERMS - 1 - term);
        Self {
            sqrt_forgetting: libm::sqrt(forgetting) as f32,
            weights: TermVector::from_fn(|term, _| scaled(start(term))[term]),
            renewal: scaled(renewal),
            bound: penalty.scaled_lambda1(),
            step: TermVector::from_fn(|i, _| (dual_step / (NT_PER_UNIT[i] * NT_PER_UNIT[i])) as f32),
        }
    }

    /// Dual step, eqs. (14), (15), (18): ascent along the extrapolated primal, clipped to the bound.
    fn dual_ascent(&self, dual: &mut TermVector, now: &TermVector, before: &TermVector) {
        for (i, dual) in dual.iter_mut().enumerate() {
            let raised = *dual + self.step[i] * (2.0 * now[i] - before[i]);
            *dual = clamped(raised, self.bound[i]);
        }
    }
}

/// As [`f32::clamp`], whose panic and its message take flash.
fn clamped(value: f32, bound: f32) -> f32 {
    if value > bound {
        bound
    } else if value < -bound {
        -bound
    } else {
        value
    }
}

impl Estimator for SaddlePoint {
    type State = RecursiveState;

    const IDLE: RecursiveState = RecursiveState::IDLE;

    /// `P_0^-1 = lambda2 I`, `q_0 = lambda2 beta_0`, `z_0 = 0`: eq. (17) started at the calibration.
    fn start(&self, state: &mut RecursiveState, prior: &Prior) {
        *state = RecursiveState::start(&self.weights, prior.coefficients);
    }

    /// Eq. (16) with the information factor in place of eq. (17), then eq. (18). The `(1 - gamma) lambda2 I` that
    /// renews the penalty comes one row an epoch, 18 times as heavy, in turn: the penalty in force then stays within
    /// 0.1 % of `lambda2` (at forgetting 0.9999) for a quarter of the work.
    fn update(&self, state: &mut RecursiveState, row: &Row) {
        state.factor.forget(self.sqrt_forgetting);
        state.factor.add(row);
        state.factor.add_penalty(state.next_penalty, self.renewal[state.next_penalty]);
        state.next_penalty = (state.next_penalty + 1) % TERMS;
        let before = to_terms(state.coefficients.basis());
        state.solve();
        self.dual_ascent(&mut state.dual, &to_terms(state.coefficients.basis()), &before);
    }
}
