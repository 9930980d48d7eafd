//! Whether a candidate is worth naming: by its chance, by its size beside what was found, by parts held out.

use crate::diagnosis::evidence::shrink::held_out_gain;
use crate::diagnosis::search::Candidate;
use crate::diagnosis::selection::Search;
use crate::diagnosis::selection::noise::{NOISE_DENSITY_RATIO, VARIANCE_MODEL_ERROR};
use crate::effects::HeldOut;

/// Logarithm of the chance to name any one effect that is not there: with twenty of them, one clean recording in 20,000.
/// On measured noise models it is several times that.
pub(crate) const LOG_FALSE_ALARM: f64 = -13.0;
/// Share of what was found already that one more effect must explain at least; more where a variance is in play.
const SMALL: f64 = 0.003;
const SMALL_RANDOM: f64 = 0.01;
/// One colour stands for both the noise and a random effect: what that misses looks like another one.
const SMALL_BOTH_RANDOM: f64 = 0.2;
/// Whitened squares of which no doubt is: of less, so much must be gone on parts that were held out too.
const SURELY: f64 = 1000.0;
const LEAST_HELD_OUT: f64 = 0.1;
/// How near to the edge of an effect's band a periodic effect is the cut itself, Hz.
const EDGE_HZ: f64 = 0.02;
impl Search<'_> {
    pub(crate) fn is_accepted(&self, candidate: &Candidate) -> bool {
        self.log_p(candidate) < LOG_FALSE_ALARM && !self.is_small(candidate)
    }

    /// Logarithm of the chance to gain as much without the effect. How the noise of the direction is coloured by what is
    /// let through of it, and how it comes and goes, is not known well: an effect must stand out of that too.
    pub(crate) fn log_p(&self, candidate: &Candidate) -> f64 {
        let variance_cv = self.variance_cv();
        if candidate
            .variance
            .as_ref()
            .is_some_and(|variance| variance.most() - 1.0 < VARIANCE_MODEL_ERROR * variance_cv)
        {
            return 0.0;
        }
        candidate.log_p((1.0 + NOISE_DENSITY_RATIO * variance_cv) * self.variance())
    }

    /// Whether a candidate explains so little, next to what was found already, that the imperfection of that may be it.
    fn is_small(&self, candidate: &Candidate) -> bool {
        let found: f64 = self.named.iter().map(|named| named.candidate.glrt).sum();
        let share = match (candidate.variance.is_some(), self.named.iter().any(|n| n.candidate.variance.is_some())) {
            (false, false) => SMALL,
            (true, true) => SMALL_BOTH_RANDOM,
            _ => SMALL_RANDOM,
        };
        candidate.glrt < found * share
    }

    /// Whether it has the frequency at which the band of an effect that was found ends: what a forward model cuts off
    /// there differs from what nature did.
    pub(crate) fn is_edge_of_band(&self, candidate: &Candidate) -> bool {
        let spec = |candidate: &Candidate| self.problem.library[candidate.term.effect].spec();
        let Some(hz) = self.problem.library[candidate.term.effect].fundamental_hz(&candidate.term.at) else {
            return false;
        };
        let mut edges_hz = self.named.iter().flat_map(|named| spec(&named.candidate).band_edges_hz);
        edges_hz.any(|edge_hz| (hz - edge_hz).abs() < EDGE_HZ)
    }

    /// A train of pulses can be bent until it meets a few rows: one that is not strong must explain something on parts of
    /// the recording that it was not fitted to, too. A step shows at its moment alone, which cannot be held out, but it
    /// must not do harm there.
    pub(crate) fn holds(&self, named: usize) -> bool {
        let candidate = &self.named[named].candidate;
        let least = match self.problem.library[candidate.term.effect].spec().held_out {
            HeldOut::NotAsked => return true,
            HeldOut::MustExplain => LEAST_HELD_OUT,
            HeldOut::MustNotHarm => -LEAST_HELD_OUT,
        };
        let (Some(index), variance) = (self.term_index(named), self.variance()) else { return true };
        candidate.glrt > SURELY * variance
            || held_out_gain(&self.problem, &self.fit, index, variance) > least * candidate.glrt
    }
}
