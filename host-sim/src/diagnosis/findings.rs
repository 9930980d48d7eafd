//! Everything that was found in both channels, before it is weighed.

use super::null::finding::Finding;
use super::null::omnibus::tests;
use super::policy::{
    FALSE_ALARM, LOG_BY_ATTITUDE, LOG_BY_MOTION, MANY, PIECED, SMALL_BOTH_RANDOM, SMALL_BUT_CLEAR, SMALL_REST, TESTS,
};
use super::reconstruct::direction_noise::DirectionNoise;
use super::reconstruct::prepared::Prepared;
use super::rounding::Rounding;
use super::search::Candidate;
use super::search::multiples::QuantisationGrid;
use super::search::recorded::RecordedColumn;
use super::search::repeats::Repeats;
use super::selection::Selection;
use super::targets::Targets;
use crate::effects::{Channel, Library, Spec};

/// What was found in a recording.
pub(crate) struct Findings<'a> {
    pub(crate) table: &'a Prepared,
    /// The effects that make sense on this recording.
    pub(crate) library: &'a Library,
    /// All effects, those too that make no sense on it.
    pub(crate) specs: Vec<&'static Spec>,
    pub(crate) scalar: ChannelFindings<'a>,
    pub(crate) fluxgate: ChannelFindings<'a>,
    pub(crate) exact: ExactFindings,
    /// Recorded columns that explain what no model of the noise lets through.
    pub(crate) columns: Vec<RecordedColumn>,
    /// Passing iron, which is no gap.
    pub(crate) targets: Targets,
    /// What both sensors' readings are rounded to.
    pub(crate) rounding: Rounding,
}

/// What was found in a channel.
pub(crate) struct ChannelFindings<'a> {
    /// The effects that are at work, and the fit of them.
    pub(crate) selection: Selection<'a>,
    /// What the tests that know no effect say of the residual.
    pub(crate) tests: Vec<Finding>,
    /// Where much is left: the effects that are at work beside that.
    pub(crate) beside_rest: Option<Selection<'a>>,
    /// Whether those are more likely pieces of what is left, by what one input alone makes of both: then none is named.
    pub(crate) is_outdone: bool,
}

impl<'a> ChannelFindings<'a> {
    /// Where the effects come from that may be named.
    pub(crate) fn named_from(&self) -> &Selection<'a> {
        self.beside_rest.as_ref().unwrap_or(&self.selection)
    }

    /// Before what is left is tested.
    pub(crate) fn untested(selection: Selection<'a>) -> Self {
        Self { selection, tests: Vec::new(), beside_rest: None, is_outdone: false }
    }

    /// With what the tests say of what is left.
    fn tested(self, direction_noise: Option<&DirectionNoise>, table: &Prepared) -> Self {
        Self { tests: tests(&self.selection, direction_noise, table), ..self }
    }

    /// With the effects that are at work beside what is left, if that is much.
    fn with_beside_rest(self) -> Self {
        let beside_rest = (self.share_left() > SMALL_REST).then(|| self.selection.beside_rest());
        Self { beside_rest, ..self }
    }

    /// Findings that noise alone would hardly make.
    pub(crate) fn significant(&self) -> impl Iterator<Item = &Finding> {
        let limit = |finding: &Finding| match finding.what {
            "attitude" | "memory" | "motion" | "inputs" => LOG_BY_MOTION,
            _ => (FALSE_ALARM / TESTS).ln(),
        };
        self.tests.iter().filter(move |finding| finding.log_p < limit(finding))
    }

    /// How much of all excess of a channel is left: what the tests found over that and what was explained.
    pub(crate) fn share_left(&self) -> f64 {
        let (rest, explained) = (self.rest(), self.explained(|_| true));
        let share = rest / (rest + explained).max(1e-9);
        if self.is_pieced_together() { share.max(PIECED) } else { share }
    }

    /// The largest excess that a test found; 0 where none did. What the model of a random effect has wrong of its course and its colour
    /// is no other effect.
    fn rest(&self) -> f64 {
        let of_random = self.explained(|candidate| candidate.variance.is_some());
        let counted = |finding: &Finding| match finding.what {
            "loudness" | "variance" | "bursts" | "lines" => finding.excess - SMALL_BOTH_RANDOM * of_random,
            _ => finding.excess,
        };
        self.significant().map(counted).fold(0.0, f64::max)
    }

    /// Evidence of some of what was accepted.
    fn explained(&self, is_counted: impl Fn(&Candidate) -> bool) -> f64 {
        let Selection { accepted, variance, .. } = &self.selection;
        let counted = accepted.iter().map(|accepted| &accepted.candidate).filter(|candidate| is_counted(candidate));
        // That of a variance does not depend on how loud the noise is.
        let unit = |candidate: &Candidate| if candidate.variance.is_some() { 1.0 } else { *variance };
        counted.map(|candidate| candidate.glrt / unit(candidate)).sum()
    }

    /// Whether what was found are as likely as not pieces of an effect that nobody knows: so many in a channel that still
    /// shows a rest, or a rest that surely goes with the attitude.
    fn is_pieced_together(&self) -> bool {
        let many = self.selection.accepted.len() >= MANY && self.rest() > 0.0;
        // The imperfection of what was found goes with the attitude as that does.
        let imperfection = SMALL_BUT_CLEAR * self.explained(|_| true);
        let is_by_attitude = |finding: &Finding| {
            ["attitude", "memory"].contains(&finding.what)
                && finding.log_p < LOG_BY_ATTITUDE
                && finding.excess > imperfection
        };
        many || self.tests.iter().any(is_by_attitude)
    }
}

/// What needs no fit, each with the index of its effect.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactFindings {
    /// Scalar readings that repeat the one before.
    pub(crate) repeats: Option<(usize, Repeats)>,
    /// Fluxgate readings that are multiples of a step.
    pub(crate) multiples: Option<(usize, QuantisationGrid)>,
}

impl ExactFindings {
    /// Whether anything was found: it has no chance to be noise.
    pub(crate) fn is_any(&self) -> bool {
        self.repeats.is_some() || self.multiples.is_some()
    }
}

impl<'a> Findings<'a> {
    /// With what the tests say of what is left of each channel, beside the noise of the fluxgate's direction.
    pub(crate) fn tested(self, direction_noise: &DirectionNoise) -> Self {
        let is_sound = self.fluxgate.selection.accepted.is_empty() && self.exact.multiples.is_none();
        let direction_noise = is_sound.then_some(direction_noise);
        let tested = |channel: ChannelFindings<'a>| channel.tested(direction_noise, self.table);
        Self { scalar: tested(self.scalar), fluxgate: tested(self.fluxgate), ..self }
    }

    /// Whether the tests find something in what is left of a channel.
    pub(crate) fn has_rest(&self) -> bool {
        self.channels().iter().any(|channel| channel.significant().next().is_some())
    }

    /// With the effects of each channel that are at work beside what is left of it.
    pub(crate) fn with_beside_rest(self) -> Self {
        Self { scalar: self.scalar.with_beside_rest(), fluxgate: self.fluxgate.with_beside_rest(), ..self }
    }

    /// With what is outdone by an input alone in some channels.
    pub(crate) fn with_outdone(self, channels: &[Channel]) -> Self {
        let marked = |channel: ChannelFindings<'a>| {
            let is_outdone = channels.contains(&channel.selection.problem.channel);
            ChannelFindings { is_outdone, ..channel }
        };
        Self { scalar: marked(self.scalar), fluxgate: marked(self.fluxgate), ..self }
    }

    /// Both channels, the scalar first.
    pub(crate) fn channels(&self) -> [&ChannelFindings<'a>; 2] {
        [&self.scalar, &self.fluxgate]
    }

    /// One of them.
    pub(crate) fn channel(&self, channel: Channel) -> &ChannelFindings<'a> {
        match channel {
            Channel::Scalar => &self.scalar,
            Channel::Fluxgate => &self.fluxgate,
        }
    }
}
