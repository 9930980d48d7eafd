//! Everything that was found in both channels, before it is weighed.

use super::null::finding::Finding;
use super::reconstruct::prepared::Prepared;
use super::rounding::Rounding;
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
