//! What no named effect explains, and how much of the gap it is.

use super::channels::strongest_effect;
use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::ChannelFindings;
use crate::diagnosis::policy::{
    LEAST_CLOSED, LOG_UNPROVED, NAMED_BESIDE_REST, NAMED_COLUMN_BESIDE_REST, PROVED_SHARE, SMALL_REST,
    SURENESS_OF_UNPROVED, SUREST, SUREST_COLUMN_WITH_REST, SUREST_WITH_LITTLE, SUREST_WITH_REST,
};
use crate::diagnosis::result::{EffectFound, Unexplained};

/// What is left over in a channel.
pub(super) struct Rest {
    /// Tests that noise alone would hardly meet.
    pub(super) unexplained: Vec<Unexplained>,
    /// Whether anything significant is left.
    pub(super) is_significant: bool,
    /// Its share of the excess.
    pub(super) share: f64,
}

impl Rest {
    /// `effects` are those of the channel.
    pub(super) fn of(channel: &ChannelFindings<'_>, effects: &[EffectFound]) -> Self {
        let unproved = effects.is_empty().then(|| unproved(channel)).flatten();
        let unexplained: Vec<Unexplained> = unexplained(channel).chain(unproved).collect();
        // Of a weak effect the share is not known well enough to say that anything stays.
        let best = effects.iter().map(|effect| effect.gap_closed).max_by(|a, b| a.fraction.total_cmp(&b.fraction));
        let stays = best.filter(|best| best.ci95[1] < LEAST_CLOSED).map_or(0.0, |best| 1.0 - best.fraction.max(0.0));
        Self {
            is_significant: !unexplained.is_empty() || stays > 0.0,
            unexplained,
            share: channel.share_left().max(stays),
        }
    }

    /// Whether so much is left that what is named may be a piece of it.
    pub(super) fn is_large(&self) -> bool {
        self.is_significant && self.share > SMALL_REST
    }

    /// Whether an effect is named beside it: where it closes most of the gap beyond doubt.
    pub(super) fn leaves(&self, effect: &EffectFound) -> bool {
        let least = match (&effect.load, effect.is_noise_without_edge) {
            (Some(_), _) => NAMED_COLUMN_BESIDE_REST,
            (None, true) => f64::INFINITY,
            (None, false) => NAMED_BESIDE_REST,
        };
        !self.is_large() || effect.gap_closed.ci95[0] >= least
    }

    /// Probability of an effect that is named beside it, were there no other that does as well.
    pub(super) fn surest(&self, effect: &EffectFound) -> f64 {
        let proved = (effect.gap_closed.ci95[0] / PROVED_SHARE).clamp(0.0, 1.0);
        let by_rest = match self.is_large() {
            false if self.is_significant => SUREST_WITH_LITTLE,
            false => SUREST,
            true if effect.load.is_some() => SUREST_COLUMN_WITH_REST,
            true => SUREST_WITH_REST,
        };
        by_rest * (SURENESS_OF_UNPROVED + (1.0 - SURENESS_OF_UNPROVED) * proved)
    }
}

/// Findings of a channel, as they are told.
fn unexplained<'b>(channel: &'b ChannelFindings<'_>) -> impl Iterator<Item = Unexplained> + 'b {
    channel.significant().map(|finding| told(channel, finding.what, finding.log_p))
}

fn told(channel: &ChannelFindings<'_>, what: &'static str, log_p: f64) -> Unexplained {
    Unexplained { channel: channel_name(channel.selection.problem.channel), what, p_value: log_p.exp() }
}

/// What looks like an effect beyond any doubt about the noise, where nothing is named: no part of the recording proved it that
/// it had not been fitted to.
fn unproved(channel: &ChannelFindings<'_>) -> Option<Unexplained> {
    let least = strongest_effect(channel);
    (least <= LOG_UNPROVED).then(|| told(channel, "unproved", least))
}
