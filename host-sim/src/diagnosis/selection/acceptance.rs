//! Whether a candidate is worth naming: by its chance, by its size beside what was found, by parts held out.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::state::{Accepted, State};
use crate::diagnosis::evidence::accounted::{Whitened, by_variance};
use crate::diagnosis::evidence::shrink::{GapClosed, gap_closed, held_out_gain};
use crate::diagnosis::noise::model::tolerance;
use crate::diagnosis::policy::{
    BAND_EDGE_HZ, BEYOND_DOUBT, LEAST_ACCOUNTED, LEAST_CLOSED_BY_COLUMN, LEAST_CLOSED_SHARE, LEAST_HELD_OUT,
    LOG_CLEAR_SEARCHED, LOG_CONE_FIRST, LOG_FALSE_ALARM, LOG_FALSE_ALARM_CONE, LOG_FALSE_ALARM_SEARCHED,
    PULSE_PERIODS_WITHIN, SMALL, SMALL_BOTH_RANDOM, SMALL_BUT_CLEAR, SMALL_RANDOM,
};
use crate::diagnosis::regression::problem::Fit;
use crate::diagnosis::search::Candidate;
use crate::effects::{HeldOut, Search};

/// Logarithm of the chance from which on what was looked for in some way is no false alarm.
pub(crate) fn log_false_alarm(search: Search) -> f64 {
    match search {
        Search::Cone => LOG_FALSE_ALARM_CONE,
        search if search.tries_many() => LOG_FALSE_ALARM_SEARCHED,
        _ => LOG_FALSE_ALARM,
    }
}

impl State<'_> {
    /// Whether it is worth adding to what was accepted.
    pub(super) fn is_accepted(&self, candidate: &Candidate) -> bool {
        self.is_accepted_at(candidate, self.log_p(candidate))
    }

    /// Whether an effect that is not random would be, were there no noise of the direction.
    pub(super) fn would_be_accepted(&self, candidate: &Candidate) -> bool {
        candidate.variance.is_none() && self.is_accepted_at(candidate, self.log_p_beside(candidate, 0.0))
    }

    fn is_accepted_at(&self, candidate: &Candidate, log_p: f64) -> bool {
        self.is_beyond_chance(candidate, log_p)
            && !self.is_small(candidate)
            && self.log_p_of_many(candidate, log_p) <= LOG_FALSE_ALARM
    }

    /// The logarithm `log_p` of the chance of one that is not in the fit: of what was looked for, that without a few large values if
    /// it is not beyond chance without them.
    pub(super) fn log_p_of_many(&self, candidate: &Candidate, log_p: f64) -> f64 {
        if !self.is_searched(candidate) || candidate.variance.is_some() || log_p > LOG_FALSE_ALARM {
            return log_p;
        }
        let of_many = self.log_p_without_tails(candidate);
        if of_many > LOG_FALSE_ALARM { of_many } else { log_p }
    }

    /// Whether the logarithm of a chance is so low that the effect is no false alarm.
    pub(super) fn is_beyond_chance(&self, candidate: &Candidate, log_p: f64) -> bool {
        log_p <= log_false_alarm(self.search(candidate)) && self.comes_again(candidate)
    }

    /// Whether a moment, a period, a frequency or a cone was looked for.
    fn is_searched(&self, candidate: &Candidate) -> bool {
        self.search(candidate).tries_many()
    }

    pub(super) fn search(&self, candidate: &Candidate) -> Search {
        self.problem.library[candidate.term.effect].spec().search
    }

    /// Whether it is a cone beyond doubt: the noise in it is no noise to anything else, which is therefore looked for later.
    pub(super) fn comes_first(&self, candidate: &Candidate) -> bool {
        self.search(candidate) == Search::Cone && self.log_p(candidate) <= LOG_CONE_FIRST
    }

    /// Whether what has a period has enough of them in the recording: what was fitted to a few rows is none.
    fn comes_again(&self, candidate: &Candidate) -> bool {
        let fundamental_hz = self.problem.library[candidate.term.effect].fundamental_hz(&candidate.term.at);
        fundamental_hz.is_none_or(|hz| hz * self.problem.duration_s() >= PULSE_PERIODS_WITHIN)
    }

    /// The same of one that was accepted, by the chance that was judged last.
    pub(super) fn is_still_accepted(&self, accepted: usize) -> bool {
        let Accepted { candidate, log_p, .. } = &self.accepted[accepted];
        self.is_beyond_chance(candidate, *log_p)
    }

    /// Logarithm of the chance to gain as much without the effect. How the noise of the direction is coloured by what is
    /// let through of it, and how it comes and goes, is not known well, nor the noise's colour: an effect must stand out of that
    /// too. One that is random must stand out by ranks, whatever the distribution of the noise.
    pub(super) fn log_p(&self, candidate: &Candidate) -> f64 {
        self.log_p_in(candidate, &self.fit)
    }

    /// The same of one that is not in another fit.
    pub(super) fn log_p_in(&self, candidate: &Candidate, fit: &Fit) -> f64 {
        let is_beside_direction = self.noise.direction.is_some() && candidate.variance.is_none();
        let denser = if is_beside_direction { self.noise.denser(&self.projected(candidate, fit)) } else { 0.0 };
        self.log_p_beside(candidate, denser)
    }

    /// The same where the noise may be denser by such a share than the model has it.
    fn log_p_beside(&self, candidate: &Candidate, denser: f64) -> f64 {
        let known = 1.0 + tolerance(self.problem.whitening.samples());
        match &candidate.variance {
            Some(added) => Candidate { glrt: self.louder(candidate, added), ..candidate.clone() }.log_p(known),
            None => candidate.log_p((known + denser) * self.variance()),
        }
    }

    /// Whether a candidate explains so little, next to what was found already, that the imperfection of that may be it.
    fn is_small(&self, candidate: &Candidate) -> bool {
        if self.accepted.is_empty() {
            return false;
        }
        let found: f64 = self.accepted.iter().map(|accepted| accepted.candidate.glrt).sum();
        let has_random = self.accepted.iter().any(|accepted| accepted.candidate.variance.is_some());
        let clear = if self.is_searched(candidate) { LOG_CLEAR_SEARCHED } else { LOG_FALSE_ALARM_SEARCHED };
        let is_clear = || self.log_p(candidate) <= clear;
        let share = match (candidate.variance.is_some(), has_random) {
            (false, false) if is_clear() => SMALL_BUT_CLEAR,
            (false, false) => SMALL,
            (true, true) => SMALL_BOTH_RANDOM,
            (true, false) if is_clear() => SMALL,
            _ => SMALL_RANDOM,
        };
        candidate.glrt < found * share
    }

    /// Whether it has the frequency at which the band of an effect that was found ends: what a forward model cuts off
    /// there differs from what nature did.
    pub(super) fn is_edge_of_band(&self, candidate: &Candidate) -> bool {
        let spec = |candidate: &Candidate| self.problem.library[candidate.term.effect].spec();
        let Some(hz) = self.problem.library[candidate.term.effect].fundamental_hz(&candidate.term.at) else {
            return false;
        };
        let mut edges_hz = self.accepted.iter().flat_map(|accepted| spec(&accepted.candidate).band_edges_hz);
        edges_hz.any(|edge_hz| (hz - edge_hz).abs() < BAND_EDGE_HZ)
    }

    /// A train of pulses can be bent until it meets a few rows: one that is not strong must explain something on parts of
    /// the recording that it was not fitted to, too. A step shows at its moment alone, which cannot be held out, but it
    /// must not do harm there.
    pub(super) fn holds(&self, accepted: usize) -> bool {
        let candidate = &self.accepted[accepted].candidate;
        let least = match self.problem.library[candidate.term.effect].spec().held_out {
            HeldOut::NotAsked => return true,
            HeldOut::MustExplain => LEAST_HELD_OUT,
            HeldOut::MustNotHarm => -LEAST_HELD_OUT,
        };
        let (Some(index), variance) = (self.term_index(accepted), self.variance()) else { return true };
        candidate.glrt > BEYOND_DOUBT * variance
            || held_out_gain(&self.problem, &self.fit, index, variance) > least * candidate.glrt
    }

    /// Without the effects that explain nothing, as far as parts tell that they were not fitted to: the one that explains
    /// least first, as the others may then do better.
    pub(super) fn without_unproved(self) -> Self {
        let mut state = self;
        while let Some(least) = state.least_proved() {
            state = state.without(least);
        }
        state
    }

    fn least_proved(&self) -> Option<usize> {
        let closed = |accepted: usize| (accepted, self.closed(accepted));
        let unproved = |(accepted, closed): &(usize, GapClosed)| {
            let candidate = &self.accepted[*accepted].candidate;
            let is_column = self.problem.library[candidate.term.effect].load().is_some();
            let least = match (candidate.variance.is_some(), is_column) {
                (true, _) => LEAST_ACCOUNTED,
                (false, true) => LEAST_CLOSED_BY_COLUMN,
                (false, false) => LEAST_CLOSED_SHARE,
            };
            closed.fraction < least || closed.ci95[0] <= 0.0
        };
        let all = (0..self.accepted.len()).map(closed).filter(unproved);
        all.min_by(|a, b| a.1.fraction.total_cmp(&b.1.fraction)).map(|(accepted, _)| accepted)
    }

    /// Share of the excess that an effect closes on parts held out.
    fn closed(&self, accepted: usize) -> GapClosed {
        let draw = &mut ChaCha8Rng::seed_from_u64(0);
        match self.term_index(accepted) {
            Some(index) => gap_closed(&self.problem, &self.fit, index, [self.variance(); 2], draw),
            None => by_variance(&self.left(), self.random_index(accepted), draw),
        }
    }

    pub(super) fn left(&self) -> Whitened<'_> {
        Whitened {
            whitening: &self.problem.whitening,
            noise: &self.noise,
            residual_whitened: &self.fit.residual_whitened,
            variance: self.variance(),
        }
    }
}
