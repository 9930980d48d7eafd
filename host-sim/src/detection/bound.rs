//! The least that 18 fixed coefficients can leave, fitted in hindsight to the very rows that count.

use towmag::Epoch;
use towmag::estimate::SquareRootInformation;
use towmag::filter::{BandPassDesign, BandPassError};
use towmag::model::{Coefficients, TermVector};
use towmag::{FrontEnd, FrontEndState};

/// Rows between two moves of the factor's centre, which keeps its rounding errors small.
const RECENTRE_EVERY: u64 = 500;

/// Least squares of the 18 terms, in one pass.
pub(super) struct Bound {
    front_end: FrontEnd,
    state: FrontEndState,
    factor: SquareRootInformation,
    rows: u64,
    squares: f64,
}

impl Bound {
    pub(super) fn new(band_pass: BandPassDesign) -> Result<Self, BandPassError> {
        let (front_end, state) = (FrontEnd::new(band_pass)?, FrontEndState::default());
        Ok(Self { front_end, state, factor: SquareRootInformation::EMPTY, rows: 0, squares: 0.0 })
    }

    /// Every epoch, and whether it counts.
    pub(super) fn step(&mut self, epoch: &Epoch, counts: bool) {
        let Ok(observation) = self.front_end.step(&mut self.state, epoch) else { return };
        if !(counts && observation.settled) {
            return;
        }
        self.rows += 1;
        self.squares += f64::from(self.factor.add(&observation.band_passed)).powi(2);
        if self.rows.is_multiple_of(RECENTRE_EVERY)
            && let Some(solution) = Coefficients::from_basis(self.factor.solve(&TermVector::zeros()))
        {
            self.factor.recentre(&solution);
        }
    }

    /// Root mean square of the residual, nT.
    pub(super) fn rms_nt(&self) -> f64 {
        (self.squares / self.rows as f64).sqrt()
    }
}
