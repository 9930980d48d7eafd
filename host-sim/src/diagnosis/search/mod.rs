//! Where each effect would start from: its best values on what a fit leaves, and what it would explain of it.

mod axis;
mod candidate;
mod chance;
mod cone;
mod linear;
pub(crate) mod multiples;
mod onset;
mod profile;
mod pulse_train;
mod ranges;
pub(crate) mod recorded;
pub(crate) mod repeats;
mod secant;
mod tone;
mod variance;

pub(crate) use axis::{CUBIC_AND_QUARTIC, monomials};
pub(crate) use candidate::{Candidate, log_tail};
pub(crate) use cone::{Reach, reach as reach_of_cone};

use rayon::prelude::*;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::effects::{Channel, Search};

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
        Search::Ranges => ranges::scan(problem, fit, effect),
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
