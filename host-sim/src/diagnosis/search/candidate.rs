//! An effect with the values that a search found for it, and how likely noise alone is to look so.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::diagnosis::noise::variance::VarianceFit;
use crate::diagnosis::regression::term::Term;

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
    pub(super) fn growth(&self) -> Option<&[f64]> {
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
