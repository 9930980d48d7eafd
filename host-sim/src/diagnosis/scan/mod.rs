//! Where each effect would start from: its best values on what a fit leaves, and what it would explain of it.

mod dead_zone;
mod direction;
mod heading;
mod linear;
mod onset;
mod switched;
mod timing;
mod tone;
mod variance;

pub(super) use direction::direction_growth;
pub(super) use heading::monomials;
pub(super) use variance::{VarianceFit, fit_variance, innovation_variance, scale};

use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::bench::{Bench, Fit};
use super::term::Term;
use crate::effects::Channel;

/// An effect with start values.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) term: Term,
    /// Reduction of the whitened sum of squares, or twice the gain of the log likelihood for a variance.
    pub(super) gain: f64,
    /// Free parameters, as far as the recording tells them apart.
    pub(super) freedom: f64,
    /// Independent values that were tried of the parameters beyond those.
    pub(super) trials: f64,
    /// How the variance of the noise changes, of an effect that is random.
    pub(super) variance: Option<VarianceFit>,
}

impl Candidate {
    /// How much the variance of each sample grows, of an effect that is random.
    fn growth(&self) -> Option<&[f64]> {
        self.variance.as_ref().map(|variance| &variance.growth[..])
    }

    /// Logarithm of the chance to gain as much without the effect, `variance` being that of the whitened noise.
    pub(super) fn log_p(&self, variance: f64) -> f64 {
        log_tail(self.freedom, self.gain / variance) + self.trials.ln()
    }

    /// Twice the logarithm of the evidence, up to a constant: by the Bayesian information criterion.
    pub(super) fn evidence(&self, variance: f64, samples: f64) -> f64 {
        self.gain / variance - self.freedom * samples.ln() - 2.0 * self.trials.ln()
    }
}

/// Logarithm of the upper tail of chi-squared, also where the tail itself is no longer a number.
pub(super) fn log_tail(freedom: f64, value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let freedom = freedom.max(1.0);
    if let Ok(distribution) = ChiSquared::new(freedom) {
        let tail = distribution.sf(value);
        if tail > 1e-250 {
            return tail.ln();
        }
    }
    // So far out, the first term of Legendre's continued fraction will do.
    let (a, x) = (0.5 * freedom, 0.5 * value);
    a * x.ln() - x - statrs::function::gamma::ln_gamma(a) - (x + 1.0 - a).ln()
}

/// All effects of the channel that are not in the fit already, each at its best, side by side. `left_out` are
/// effects that must not be looked at.
pub(super) fn scan(bench: &Bench<'_>, fit: &Fit, left_out: &[usize]) -> Vec<Candidate> {
    let effects: Vec<usize> = (0..bench.library.len())
        .filter(|index| bench.library[*index].spec().channel == bench.channel && !left_out.contains(index))
        .collect();
    effects.into_par_iter().filter_map(|effect| scan_one(bench, fit, effect, None)).collect()
}

/// A random effect once more, with what was found before to start from.
pub(super) fn scan_again(bench: &Bench<'_>, fit: &Fit, last: &Candidate) -> Option<Candidate> {
    scan_one(bench, fit, last.term.effect, Some(last))
}

fn scan_one(bench: &Bench<'_>, fit: &Fit, effect: usize, last: Option<&Candidate>) -> Option<Candidate> {
    let found = match bench.library[effect].spec().name {
        "scalar_lag" | "clock_drift" | "averaging_window" | "scalar_lowpass" | "eddy_lag" => {
            timing::scan(bench, fit, effect)
        }
        "permanent_step" | "sample_slip" => onset::scan(bench, fit, effect),
        "heading_error" => heading::scan(bench, fit, effect),
        "mains_alias" => tone::scan(bench, fit, effect),
        "load_current" if bench.library[effect].load().is_none() => switched::scan(bench, fit, effect),
        "sample_jitter" => variance::scan_jitter(bench, fit, effect, last),
        "dead_zone" => dead_zone::scan(bench, fit, effect, last),
        // Found by exact repeats and exact multiples, before any fit.
        "stale_sample" | "fluxgate_quantisation" => None,
        _ => linear::scan(bench, fit, effect),
    };
    debug_assert!(bench.library[effect].spec().channel == Channel::Scalar || bench.refitted.is_empty());
    found.filter(|candidate| candidate.gain.is_finite() && candidate.gain > 0.0)
}

#[cfg(test)]
mod tests {
    use super::log_tail;

    #[test]
    fn the_tail_is_that_of_chi_squared_wherever_it_is() {
        // SciPy's chi2.logsf(value, freedom); the last two by mpmath, where the tail itself is no number.
        let published = [
            (1.0, 4.0, -3.090037153),
            (1000.0, 614.0, 0.0),
            (1000.0, 1100.0, -4.225747379),
            (600.0, 900.0, -31.457628565),
            (3.0, 1500.0, -746.568515158),
            (1000.0, 4000.0, -811.978728488),
        ];
        for (freedom, value, log_tail_there) in published {
            let found = log_tail(freedom, value);
            assert!((found - log_tail_there).abs() < 1e-5 * (1.0 - log_tail_there), "{freedom} {value}: {found}");
        }
    }
}
