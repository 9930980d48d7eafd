//! The estimators: immutable configuration, explicit state, one update per accepted and settled epoch.

use super::Prior;
use super::elastic_net::ElasticNet;
use super::square_root_information::SquareRootInformation;
use crate::model::Row;
use crate::model::basis::{dual_from_terms, to_terms};
use crate::model::{Coefficients, NT_PER_UNIT, TERMS, TermVector};

/// An estimator of the 18 coefficients.
pub trait Estimator {
    /// All that it remembers, the coefficients from all epochs so far among it.
    type State: AsRef<Coefficients>;

    /// The state of one that knows nothing, which [`start`](Self::start) makes something of.
    const IDLE: Self::State;

    /// Make it the state before the first epoch, given what the calibration found. In place: the largest state is
    /// ten kilobytes, of which a microcontroller's stack has no room for many copies.
    fn start(&self, state: &mut Self::State, prior: &Prior);

    /// Learn from one band-passed epoch.
    fn update(&self, state: &mut Self::State, row: &Row);
}

/// Coefficients as calibrated, for ever.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fixed;

impl Estimator for Fixed {
    type State = Coefficients;

    const IDLE: Coefficients = Coefficients::ZERO;

    fn start(&self, coefficients: &mut Coefficients, prior: &Prior) {
        *coefficients = prior.coefficients;
    }

    fn update(&self, _: &mut Coefficients, _: &Row) {}
}

/// State of an estimator that learns.
#[derive(Clone, Debug)]
pub struct Learning {
    factor: SquareRootInformation,
    coefficients: Coefficients,
    dual: TermVector,
    next_penalty: usize,
    since_recentred: u32,
}

/// Updates between two moves of the factor's centre to the latest coefficients: rare against the cost of a move, often
/// against the 10,000 epochs in which rounding errors gather before forgetting takes them.
const RECENTRE_EVERY: u32 = 1000;

impl AsRef<Coefficients> for Learning {
    fn as_ref(&self) -> &Coefficients {
        &self.coefficients
    }
}

impl Learning {
    const IDLE: Self = Self {
        factor: SquareRootInformation::EMPTY,
        coefficients: Coefficients::ZERO,
        dual: [0.0; TERMS],
        next_penalty: 0,
        since_recentred: 0,
    };

    fn start(weights: &TermVector, calibrated: Coefficients) -> Self {
        Self {
            factor: SquareRootInformation::independent(weights, &calibrated),
            coefficients: calibrated,
            dual: [0.0; TERMS],
            next_penalty: 0,
            since_recentred: 0,
        }
    }

    /// The information gathered so far.
    pub fn factor(&self) -> &SquareRootInformation {
        &self.factor
    }

    /// The coefficients from the factor and the dual; the old ones where the new ones would not be finite.
    fn solve(&mut self) {
        if let Some(coefficients) = Coefficients::from_basis(self.factor.solve(&dual_from_terms(&self.dual))) {
            self.coefficients = coefficients;
        }
        self.since_recentred += 1;
        if self.since_recentred == RECENTRE_EVERY {
            self.since_recentred = 0;
            self.factor.recentre(&self.coefficients);
        }
    }
}

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
    type State = Learning;

    const IDLE: Learning = Learning::IDLE;

    fn start(&self, state: &mut Learning, prior: &Prior) {
        *state = Learning::start(&self.weights, prior.coefficients);
    }

    fn update(&self, state: &mut Learning, row: &Row) {
        state.factor.forget(self.sqrt_forgetting);
        state.factor.add(row);
        state.solve();
    }
}

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
            weights: core::array::from_fn(|term| scaled(start(term))[term]),
            renewal: scaled(renewal),
            bound: penalty.scaled_lambda1(),
            step: core::array::from_fn(|i| (dual_step / (NT_PER_UNIT[i] * NT_PER_UNIT[i])) as f32),
        }
    }

    /// Dual step, eqs. (14), (15), (18): ascent along the extrapolated primal, clipped to the bound.
    fn ascend(&self, dual: &mut TermVector, now: &TermVector, before: &TermVector) {
        for (i, dual) in dual.iter_mut().enumerate() {
            let raised = *dual + self.step[i] * (2.0 * now[i] - before[i]);
            *dual = clipped(raised, self.bound[i]);
        }
    }
}

/// As `clamp`, which has a panic and all the formatting of its message in it.
fn clipped(value: f32, bound: f32) -> f32 {
    if value > bound {
        bound
    } else if value < -bound {
        -bound
    } else {
        value
    }
}

impl Estimator for SaddlePoint {
    type State = Learning;

    const IDLE: Learning = Learning::IDLE;

    /// `P_0^-1 = lambda2 I`, `q_0 = lambda2 beta_0`, `z_0 = 0`: eq. (17) started at the calibration.
    fn start(&self, state: &mut Learning, prior: &Prior) {
        *state = Learning::start(&self.weights, prior.coefficients);
    }

    /// Eq. (16) with the information factor in place of eq. (17), then eq. (18). The `(1 - gamma) lambda2 I` that
    /// renews the penalty comes one row an epoch, 18 times as heavy, in turn: the penalty in force then stays within
    /// 0.1 % of `lambda2` (at forgetting 0.9999) for a quarter of the work.
    fn update(&self, state: &mut Learning, row: &Row) {
        state.factor.forget(self.sqrt_forgetting);
        state.factor.add(row);
        state.factor.add_penalty(state.next_penalty, self.renewal[state.next_penalty]);
        state.next_penalty = (state.next_penalty + 1) % TERMS;
        let before = to_terms(state.coefficients.basis());
        state.solve();
        self.ascend(&mut state.dual, &to_terms(state.coefficients.basis()), &before);
    }
}
