//! What an estimator is: immutable configuration, explicit state, one update per accepted and settled epoch.

use super::Prior;
use crate::model::{Coefficients, Row};

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
