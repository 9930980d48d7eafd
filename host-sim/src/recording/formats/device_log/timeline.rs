//! One time axis for the sessions of a log.

use std::collections::HashMap;

use super::placement::{Placement, Span};
use crate::recording::rate::RATE_HZ;

/// Where an epoch lies on the one axis.
pub(super) struct Place {
    pub(super) time_s: f64,
    /// Seconds since the epoch before, when that is a gap.
    pub(super) gap_s: Option<f64>,
    /// Epochs since the first; wraps.
    pub(super) tick: u32,
}

/// Puts the ticks of several sessions on one time axis.
#[derive(Debug, Default)]
pub(super) struct Timeline {
    origin_s: f64,
    /// Of each session: its first tick, and where that stands, epochs after the origin.
    starts: HashMap<u32, (u32, u64)>,
    /// Where the latest epoch of any session stands.
    last: Option<u64>,
}

impl Timeline {
    /// For spans that stand there.
    pub(super) fn new(spans: &[Span], placement: &Placement) -> Self {
        let starts = spans.iter().zip(&placement.starts).map(|(span, start)| (span.session, (span.ticks[0], *start)));
        Self { origin_s: placement.origin_s, starts: starts.collect(), last: None }
    }

    /// Where an epoch lies on the one axis; `None` for one that does not come after the one before.
    pub(super) fn epoch(&mut self, session: u32, tick: u32) -> Option<Place> {
        let (first, start) = *self.starts.get(&session)?;
        let ahead = tick.wrapping_sub(first);
        let stands = start + u64::from(ahead);
        if ahead > u32::MAX / 2 || self.last.is_some_and(|last| stands <= last) {
            return None;
        }
        let step = self.last.replace(stands).map_or(0, |last| stands - last);
        let gap_s = (step > 1).then_some(step as f64 / RATE_HZ);
        let time_s = ((self.origin_s + stands as f64 / RATE_HZ) * 1000.0).round() / 1000.0;
        Some(Place { time_s, gap_s, tick: stands as u32 })
    }
}
