//! What no named effect explains, and how much of the gap it is.

use crate::diagnosis::evidence::localise::channel_name;
use crate::diagnosis::findings::ChannelFindings;
use crate::diagnosis::null::omnibus::Finding;
use crate::diagnosis::policy::{FALSE_ALARM, LEAST_CLOSED, LOG_BY_ATTITUDE, MANY, PIECED, TESTS};
use crate::diagnosis::result::{EffectFound, Unexplained};

/// What is left over.
pub(super) struct Rest {
    /// Tests that noise alone would hardly meet.
    pub(super) unexplained: Vec<Unexplained>,
    /// Whether anything significant is left.
    pub(super) is_significant: bool,
    /// Its share of the excess, in the channel where it is largest.
    pub(super) share: f64,
}

impl Rest {
    pub(super) fn of(channels: &[&ChannelFindings<'_>], effects: &[EffectFound]) -> Self {
        let unexplained: Vec<Unexplained> = channels.iter().copied().flat_map(unexplained).collect();
        let closed = effects.iter().map(|effect| effect.gap_closed.fraction).reduce(f64::max);
        let stays = closed.filter(|closed| *closed < LEAST_CLOSED).map_or(0.0, |closed| 1.0 - closed.max(0.0));
        let share = channels.iter().copied().map(share_of).fold(stays, f64::max);
        Self { is_significant: !unexplained.is_empty() || stays > 0.0, unexplained, share }
    }
}

/// Findings of a channel, as they are told.
fn unexplained(channel: &ChannelFindings<'_>) -> Vec<Unexplained> {
    let of = |finding: &Finding| Unexplained {
        channel: channel_name(channel.selection.problem.channel),
        what: finding.what,
        p_value: finding.log_p.exp(),
    };
    significant(channel).map(of).collect()
}

/// Findings that noise alone would hardly make.
fn significant<'b>(channel: &'b ChannelFindings<'_>) -> impl Iterator<Item = &'b Finding> {
    let limit = (FALSE_ALARM / TESTS).ln();
    channel.tests.iter().filter(move |finding| finding.log_p < limit)
}

/// How much of all excess of a channel is left: what the tests found over that and what was explained.
fn share_of(channel: &ChannelFindings<'_>) -> f64 {
    let selection = &channel.selection;
    let rest = significant(channel).map(|finding| finding.excess).fold(0.0, f64::max);
    let explained: f64 = selection.accepted.iter().map(|accepted| accepted.candidate.glrt / selection.variance).sum();
    let share = rest / (rest + explained).max(1e-9);
    if is_pieced_together(channel) { share.max(PIECED) } else { share }
}

/// Whether what was named are as likely as not pieces of an effect that nobody knows: so many in a channel that still
/// shows a rest, or a rest that surely goes with the attitude.
fn is_pieced_together(channel: &ChannelFindings<'_>) -> bool {
    let many = channel.selection.accepted.len() >= MANY && significant(channel).next().is_some();
    let is_by_attitude = |finding: &Finding| ["attitude", "memory"].contains(&finding.what);
    many || channel.tests.iter().any(|finding| is_by_attitude(finding) && finding.log_p < LOG_BY_ATTITUDE)
}
