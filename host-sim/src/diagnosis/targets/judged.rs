//! Whether a dipole that one sensor shows is a target, by what the other one says.

use super::dipole::Dipole;
use super::residual::{Fitted, Residual};
use crate::diagnosis::policy::{
    TARGET_CLEAR_DISTANCES_S, TARGET_CLEAR_GLRT, TARGET_CLEAR_LEFT, TARGET_CLEAR_LOG_ODDS, TARGET_CLEAR_MISFIT,
    TARGET_CLEAR_NOISE, TARGET_LEFT_MOST, TARGET_RATIOS, TARGET_SEEN_STRENGTH,
};

/// Which targets may be taken for one; each also those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Trust {
    /// Those that both sensors have.
    SeenByBoth,
    /// Those of the scalar that nothing but a target looks like.
    Clear,
    /// Those of the scalar that are too weak for the fluxgate to tell.
    Unseen,
}

/// That a dipole fitted to one sensor is a target, by what the `other` says; none where it is not taken for one.
/// `is_clear` tells whether it would be one if the other sensor says nothing. With it, whether the other has it, too.
pub(super) fn probability(
    fitted: &Fitted,
    noise: f64,
    other: &Residual<'_>,
    trust: Trust,
    is_clear: impl Fn() -> bool,
) -> Option<(f64, bool)> {
    let seen = other.seen(&fitted.dipole);
    // Logarithm of the likelihood that the other has it over that it has nothing.
    let log_ratio = 0.5 * (2.0 * seen.ratio - 1.0) * seen.strength * seen.strength;
    let tells = seen.strength >= TARGET_SEEN_STRENGTH;
    if tells && (TARGET_RATIOS[0]..=TARGET_RATIOS[1]).contains(&seen.ratio) {
        return Some((odds(log_ratio + 2.0), true));
    }
    if trust < Trust::Clear || !is_clear() {
        return None;
    }
    let log_odds = log_ratio + log_odds_before(&fitted.dipole);
    if is_nothing_else(fitted, noise) && log_odds >= 0.0 {
        return Some((odds(log_odds + 1.0), false));
    }
    let is_dipole = !tells && fitted.left() <= TARGET_LEFT_MOST * noise;
    (trust == Trust::Unseen && is_dipole).then(|| (odds(log_ratio + 1.0), false))
}

/// How much likelier a clear dipole is a target than anything else before the fluxgate is asked, as a logarithm of the odds.
fn log_odds_before(dipole: &Dipole) -> f64 {
    if dipole.distance_s <= TARGET_CLEAR_DISTANCES_S[1] { TARGET_CLEAR_LOG_ODDS } else { -TARGET_CLEAR_LOG_ODDS }
}

/// Whether a dipole is so clear and leaves so little that nothing but a target looks like it.
fn is_nothing_else(fitted: &Fitted, noise: f64) -> bool {
    fitted.dipole.distance_s >= TARGET_CLEAR_DISTANCES_S[0]
        && noise <= TARGET_CLEAR_NOISE
        && fitted.glrt >= TARGET_CLEAR_GLRT * noise
        && fitted.misfit() <= TARGET_CLEAR_MISFIT
        && fitted.left() <= TARGET_CLEAR_LEFT * noise
}

/// A probability from the logarithm of the odds.
fn odds(log: f64) -> f64 {
    (1.0 / (1.0 + (-log).exp())).clamp(0.5, 0.999)
}
