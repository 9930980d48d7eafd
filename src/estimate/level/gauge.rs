//! The constant that is no interference: its mean over a circle of headings.
//!
//! A model of the direction alone is known but for a constant: what the body adds on every heading alike cannot be told from
//! the field. It is left in the compensated field, whose mean over a circle of headings is then that of the reading.

use crate::model::{Coefficients, TermVector};
use crate::policy::LEVEL_GAUGE_S;

/// Place of the permanent column of the vertical axis, and of the induced ones of the two level axes. Body axes are
/// forward, starboard, down, and a tow is level in the mean.
const VERTICAL: usize = 2;
const LEVEL_AXES: [usize; 2] = [3, 6];

/// Means of the columns that do not cancel over a circle of headings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gauge {
    epochs: f32,
    vertical: f32,
    level: f32,
}

impl Gauge {
    /// Before the first epoch.
    pub(super) const START: Self = Self { epochs: 0.0, vertical: 0.0, level: 0.0 };

    /// Take in an epoch. The vertical part of the field's direction is the same on all headings, so that the mean may be
    /// taken over whatever headings there are.
    pub(super) fn step(&mut self, columns: &TermVector, rate_hz: f32) {
        self.epochs = (self.epochs + 1.0).min(LEVEL_GAUGE_S * rate_hz);
        let share = 1.0 / self.epochs;
        self.vertical += share * (columns[VERTICAL] - self.vertical);
        self.level += share * (0.5 * (columns[LEVEL_AXES[0]] + columns[LEVEL_AXES[1]]) - self.level);
    }

    /// Mean interference over a circle of headings, nT.
    pub(super) fn mean_nt(&self, coefficients: &Coefficients) -> f32 {
        let theta = coefficients.basis();
        theta[VERTICAL] * self.vertical + (theta[LEVEL_AXES[0]] + theta[LEVEL_AXES[1]]) * self.level
    }
}
