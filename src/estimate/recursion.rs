//! What the recursions of eqs. (16) to (18) remember, and how coefficients follow from it.

use super::square_root_information::SquareRootInformation;
use crate::model::basis::dual_from_terms;
use crate::model::{Coefficients, TermVector, ZEROS};
use crate::policy::RECENTRE_EVERY;

/// State of a recursion: its information, and the coefficients that follow from it.
#[derive(Clone, Debug)]
pub struct RecursiveState {
    pub(super) factor: SquareRootInformation,
    pub(super) coefficients: Coefficients,
    /// `z` of eq. (18), of the terms.
    pub(super) dual: TermVector,
    /// Term whose penalty is renewed next.
    pub(super) next_penalty: usize,
    since_recentred: u32,
}

impl AsRef<Coefficients> for RecursiveState {
    fn as_ref(&self) -> &Coefficients {
        &self.coefficients
    }
}

impl RecursiveState {
    /// Of no use before a start.
    pub(super) const IDLE: Self = Self {
        factor: SquareRootInformation::EMPTY,
        coefficients: Coefficients::ZERO,
        dual: ZEROS,
        next_penalty: 0,
        since_recentred: 0,
    };

    /// Independent information `weights` about each calibrated coefficient, in the units of the scaled terms.
    pub(super) fn start(weights: &TermVector, calibrated: Coefficients) -> Self {
        Self {
            factor: SquareRootInformation::independent(weights, &calibrated),
            coefficients: calibrated,
            dual: ZEROS,
            next_penalty: 0,
            since_recentred: 0,
        }
    }

    /// The information gathered so far.
    pub fn factor(&self) -> &SquareRootInformation {
        &self.factor
    }

    /// The coefficients from the factor and the dual; the old ones where the new ones would not be finite.
    pub(super) fn solve(&mut self) {
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
