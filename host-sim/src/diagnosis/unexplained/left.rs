//! What no named effect explains of a channel: its residual with all that is named, the 18 terms, the background and the targets in
//! the fit, and how much of it is above noise.

use crate::diagnosis::evidence::folds::{Part, parts};
use crate::diagnosis::findings::ChannelFindings;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::dot;
use crate::diagnosis::regression::term::Term;

/// Samples that a fold holds out together: ten seconds, longer than the noise remembers and than a period of most swell.
const PART_SAMPLES: usize = 100;

/// What is left of a channel.
pub(crate) struct Left<'b, 'a> {
    pub(crate) problem: &'b RegressionProblem<'a>,
    /// The fit of what is named.
    pub(crate) fit: Fit,
    /// Whitened, everything fitted projected out.
    pub(crate) z: Vec<f64>,
    /// Sum of its squares above noise.
    pub(crate) excess: f64,
    /// Parts that are held out.
    pub(crate) parts: Vec<Part>,
    /// Variance of the noise in it.
    pub(crate) variance: f64,
}

impl<'b, 'a> Left<'b, 'a> {
    /// Beside the effects that are named: what else was found may be pieces of this.
    pub(crate) fn of(channel: &'b ChannelFindings<'a>, named: &[&str]) -> Self {
        let (own, beside) = (&channel.selection, channel.named_from());
        let is_named = |term: &&Term| named.contains(&term.name(own.problem.library));
        let terms: Vec<Term> = beside.fit.terms.iter().filter(is_named).cloned().collect();
        let fit = if terms.is_empty() { own.before.clone() } else { own.problem.fit(&terms) };
        let variance = own.sensor_variance;
        let z = fit.residual_whitened.clone();
        let dof = own.problem.whitening.dof() - fit.projection.rank() as f64;
        let excess = (dot(&z, &z) - dof.max(1.0) * variance).max(0.0);
        let parts = parts(&own.problem.whitening.ranges(), PART_SAMPLES);
        Self { problem: &own.problem, fit, z, excess, parts, variance }
    }

    /// Columns over the rows, as this residual would show them.
    pub(crate) fn swept(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.problem.projected(columns, &self.fit.projection)
    }

    /// Standard deviations by which it is above noise, about.
    pub(crate) fn strength(&self) -> f64 {
        (self.excess / self.variance.max(f64::MIN_POSITIVE)).sqrt()
    }
}
