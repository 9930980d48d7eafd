//! Where each effect would start from: its best values on what a fit leaves, and what it would explain of it.

mod axis;
mod cone;
pub(crate) mod exact;
mod linear;
mod onset;
mod profile;
mod pulse_train;
mod secant;
mod tone;
mod variance;

pub(crate) use axis::monomials;

use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::diagnosis::noise::variance::VarianceFit;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::term::Term;
use crate::effects::{Channel, Search};

/// An effect with start values.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) term: Term,
    /// Reduction of the whitened sum of squares, or twice the gain of the log likelihood for a variance.
    pub(crate) glrt: f64,
    /// Free parameters, as far as the recording tells them apart.
    pub(crate) dof: f64,
    /// Independent values that were tried of the parameters beyond those.
    pub(crate) trials_factor: f64,
    /// How the variance of the noise changes, of an effect that is random.
    pub(crate) variance: Option<VarianceFit>,
}

impl Candidate {
    /// How much the variance of each sample grows, of an effect that is random.
    fn growth(&self) -> Option<&[f64]> {
        self.variance.as_ref().map(|variance| &variance.growth[..])
    }

    /// The same with another growth of the variance, of an effect that is random.
    pub(crate) fn growing_by(self, growth: Option<&[f64]>) -> Self {
        match (self.variance, growth) {
            (Some(variance), Some(growth)) => {
                Self { variance: Some(VarianceFit { growth: growth.to_vec(), ..variance }), ..self }
            }
            (variance, _) => Self { variance, ..self },
        }
    }

    /// Logarithm of the chance to gain as much without the effect, `variance` being that of the whitened noise.
    pub(crate) fn log_p(&self, variance: f64) -> f64 {
        log_tail(self.dof, self.glrt / variance) + self.trials_factor.ln()
    }

    /// Twice the logarithm of the evidence, up to a constant: by the Bayesian information criterion.
    pub(crate) fn evidence(&self, variance: f64, samples: f64) -> f64 {
        self.glrt / variance - self.dof * samples.ln() - 2.0 * self.trials_factor.ln()
    }
}

/// Logarithm of the upper tail of chi-squared, also where the tail itself is no longer a number.
pub(crate) fn log_tail(dof: f64, value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let dof = dof.max(1.0);
    if let Ok(distribution) = ChiSquared::new(dof) {
        let tail = distribution.sf(value);
        if tail > 1e-250 {
            return tail.ln();
        }
    }
    // So far out, the first term of Legendre's continued fraction will do.
    let (a, x) = (0.5 * dof, 0.5 * value);
    a * x.ln() - x - statrs::function::gamma::ln_gamma(a) - (x + 1.0 - a).ln()
}

/// The GLRT of every effect on what a fit leaves, each at its best values.
#[derive(Clone, Debug)]
pub(crate) struct GlrtTable {
    rows: Vec<Candidate>,
}

impl GlrtTable {
    /// All effects of the channel but those excluded, side by side.
    pub(crate) fn of(problem: &RegressionProblem<'_>, fit: &Fit, excluded: &[usize]) -> Self {
        let is_asked =
            |index: &usize| problem.library[*index].spec().channel == problem.channel && !excluded.contains(index);
        let effects: Vec<usize> = (0..problem.library.len()).filter(is_asked).collect();
        Self { rows: effects.into_par_iter().filter_map(|effect| scan_one(problem, fit, effect, None)).collect() }
    }

    /// Without some of them.
    pub(crate) fn without(self, is_left_out: impl Fn(&Candidate) -> bool) -> Self {
        Self { rows: self.rows.into_iter().filter(|candidate| !is_left_out(candidate)).collect() }
    }

    /// Best evidence first.
    pub(crate) fn by_evidence(self, variance: f64, samples: f64) -> Self {
        let mut rows = self.rows;
        rows.sort_by(|a, b| b.evidence(variance, samples).total_cmp(&a.evidence(variance, samples)));
        Self { rows }
    }

    /// The candidates in their order.
    pub(crate) fn into_rows(self) -> impl Iterator<Item = Candidate> {
        self.rows.into_iter()
    }
}

/// A random effect once more, with what was found before to start from.
pub(crate) fn scan_again(problem: &RegressionProblem<'_>, fit: &Fit, last: &Candidate) -> Option<Candidate> {
    scan_one(problem, fit, last.term.effect, Some(last))
}

fn scan_one(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize, last: Option<&Candidate>) -> Option<Candidate> {
    let found = match problem.library[effect].spec().search {
        Search::Linear => linear::scan(problem, fit, effect),
        Search::Secant { starts } => secant::scan(problem, fit, effect, starts),
        Search::Profile { starts } => profile::scan(problem, fit, effect, starts),
        Search::Onset { sizes } => onset::scan(problem, fit, effect, sizes),
        Search::Axis => axis::scan(problem, fit, effect),
        Search::Tone => tone::scan(problem, fit, effect),
        Search::PulseTrain => pulse_train::scan(problem, fit, effect),
        Search::Variance { starts } => variance::scan(problem, fit, effect, starts, last),
        Search::Cone => cone::scan(problem, fit, effect, last),
        // Found before any fit.
        Search::ExactRepeats | Search::ExactMultiples => None,
    };
    debug_assert!(problem.library[effect].spec().channel == Channel::Scalar || problem.nuisance_columns.is_empty());
    found.filter(|candidate| candidate.glrt.is_finite() && candidate.glrt > 0.0)
}

#[cfg(test)]
mod tests {
    use super::log_tail;

    #[test]
    fn the_tail_is_that_of_chi_squared_wherever_it_is() {
        // SciPy's chi2.logsf(value, degrees of freedom); the last two by mpmath, where the tail itself is no number.
        let published = [
            (1.0, 4.0, -3.090037153),
            (1000.0, 614.0, 0.0),
            (1000.0, 1100.0, -4.225747379),
            (600.0, 900.0, -31.457628565),
            (3.0, 1500.0, -746.568515158),
            (1000.0, 4000.0, -811.978728488),
        ];
        for (dof, value, log_tail_there) in published {
            let found = log_tail(dof, value);
            assert!((found - log_tail_there).abs() < 1e-5 * (1.0 - log_tail_there), "{dof} {value}: {found}");
        }
    }
}
