//! Where each session of a log stands on the one time axis: at its true distance where the time of day tells it.

use std::ops::Range;

use super::session_clock::Utc;
use crate::recording::rate::{EPOCH_S, RATE_HZ};
use crate::recording::session_gap::SessionGap;

/// Where nothing tells how long the body was off between two sessions: epochs of 1,000 s, more than any filter remembers.
const UNKNOWN_PAUSE: u64 = 10_000;

/// Between two sessions, whatever the clocks say: less would be no gap.
const LEAST_PAUSE: u64 = 2;

/// A session of a log, whatever files it is in.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) session: u32,
    /// Of its first epoch and of its last.
    pub(super) ticks: [u32; 2],
    /// The times of the same; `None` where the body never knew the time.
    pub(super) times: Option<[Utc; 2]>,
}

/// The spans of a log on one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Placement {
    /// The time of the first epoch, s: that of day where a session knows it.
    pub(super) origin_s: f64,
    /// Where the first epoch of each span stands, epochs after the origin.
    pub(super) starts: Vec<u64>,
    /// What lies before each session but the first.
    pub(super) gaps: Vec<SessionGap>,
}

impl Span {
    /// Epochs from the first to the last.
    fn len(&self) -> u64 {
        u64::from(self.ticks[1].wrapping_sub(self.ticks[0]))
    }
}

/// Place the spans, which come in the order of time.
pub(super) fn place(spans: &[Span]) -> Placement {
    let mut placer = Placer { spans, starts: Vec::new(), gaps: Vec::new(), anchor: None };
    (0..spans.len()).for_each(|index| placer.add(index));
    let Placer { starts, gaps, .. } = placer;
    let first = spans.iter().zip(&starts).find_map(|(span, start)| Some((span.times?[0].utc_s, *start)));
    let origin_s = first.map_or(0.0, |(utc_s, start)| utc_s - epochs_s(start));
    Placement { origin_s, starts, gaps }
}

fn epochs_s(epochs: u64) -> f64 {
    epochs as f64 / RATE_HZ
}

struct Placer<'a> {
    spans: &'a [Span],
    starts: Vec<u64>,
    gaps: Vec<SessionGap>,
    /// The latest span whose time is known.
    anchor: Option<usize>,
}

/// By how much the clocks of two spans are apart, s.
struct Distance {
    s: f64,
    error_s: f64,
}

impl Placer<'_> {
    fn add(&mut self, index: usize) {
        let Some(before) = index.checked_sub(1) else {
            self.starts.push(0);
            self.anchor = self.spans[0].times.map(|_| 0);
            return;
        };
        let distance = self.anchor.and_then(|anchor| self.distance(anchor, index));
        let (start, gap) = match (self.anchor, distance) {
            (Some(anchor), Some(distance)) => self.by_clock(anchor, index, &distance),
            _ => (
                self.end(before) + UNKNOWN_PAUSE,
                SessionGap::unknown(self.spans[index].session, self.spans[before].session),
            ),
        };
        self.starts.push(start);
        if self.spans[index].times.is_some() {
            self.anchor = Some(index);
        }
        self.gaps.push(gap);
    }

    /// Where the last epoch of a span stands.
    fn end(&self, index: usize) -> u64 {
        self.starts[index] + self.spans[index].len()
    }

    /// From the last epoch of a span to the first of another, as far as both know the time.
    fn distance(&self, from: usize, to: usize) -> Option<Distance> {
        let ([_, end], [begin, _]) = (self.spans[from].times?, self.spans[to].times?);
        Some(Distance { s: begin.utc_s - end.utc_s, error_s: begin.error_s + end.error_s })
    }

    /// At its true distance from the anchor, if what stands between has room there.
    fn by_clock(&mut self, anchor: usize, index: usize, distance: &Distance) -> (u64, SessionGap) {
        let between = anchor + 1..index;
        let pauses = between.len() as u64 + 1;
        let taken = self.spans[between.clone()].iter().map(Span::len).sum::<u64>();
        let least = taken + pauses * LEAST_PAUSE;
        let [session, after] = [index, anchor].map(|index| self.spans[index].session);
        let missing_s = epochs_s(least) - distance.s;
        if missing_s > distance.error_s + EPOCH_S {
            let start = self.end(index - 1) + UNKNOWN_PAUSE;
            return (start, SessionGap::backwards(session, after, missing_s));
        }
        let away = ((distance.s * RATE_HZ).round().max(0.0) as u64).max(least);
        self.squeeze(between, self.end(anchor), (away - taken) / pauses);
        (self.end(anchor) + away, SessionGap::known(session, after, distance.s, distance.error_s))
    }

    /// Spans whose time is not known, between two whose is: made-up pauses no longer than there is room for.
    fn squeeze(&mut self, between: Range<usize>, mut end: u64, longest_pause: u64) {
        for index in between {
            self.starts[index] = end + UNKNOWN_PAUSE.min(longest_pause);
            end = self.end(index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOON_S: f64 = 1_790_000_000.0;

    /// A session of `len_s`, that began so long after noon if that is known.
    fn span(session: u32, len_s: f64, begin_s: Option<f64>) -> Span {
        let utc = |s: f64| Utc { utc_s: NOON_S + s, error_s: 0.02 };
        let times = begin_s.map(|begin_s| [utc(begin_s), utc(begin_s + len_s)]);
        Span { session, ticks: [7, 7 + (len_s * 10.0) as u32], times }
    }

    /// Begin of each span after noon, s.
    fn begins_s(placement: &Placement) -> Vec<f64> {
        let begin = |start: &u64| placement.origin_s + epochs_s(*start) - NOON_S;
        placement.starts.iter().map(|start| (begin(start) * 1e3).round() / 1e3).collect()
    }

    #[test]
    fn sessions_whose_times_are_known_stand_at_their_true_distances_on_the_grid() {
        let placement = place(&[span(1, 100.0, Some(0.0)), span(2, 50.0, Some(160.33)), span(3, 50.0, Some(3_900.5))]);
        // From the end of the one to the begin of the next: 60.33 and 3,690.17 s.
        assert_eq!(begins_s(&placement), [0.0, 160.3, 3_900.5]);
        let known = |session, after, gap_s: f64| SessionGap::known(session, after, gap_s, 0.04);
        for (gap, expected) in placement.gaps.iter().zip([known(2, 1, 60.33), known(3, 2, 3_690.17)]) {
            assert_eq!((&gap.session, &gap.after), (&expected.session, &expected.after));
            assert!((gap.gap_s.unwrap() - expected.gap_s.unwrap()).abs() < 1e-3, "{gap:?}");
        }
    }

    #[test]
    fn a_session_that_never_knew_the_time_stands_in_between() {
        let before = place(&[span(1, 100.0, None), span(2, 100.0, Some(0.0))]);
        assert_eq!(begins_s(&before), [-1_100.0, 0.0]);
        assert_eq!(before.gaps, [SessionGap::unknown(2, 1)]);
        let spans = [span(1, 100.0, Some(0.0)), span(2, 100.0, None), span(3, 10.0, Some(5_000.0))];
        let roomy = place(&spans);
        assert_eq!(begins_s(&roomy), [0.0, 1_100.0, 5_000.0]);
        assert_eq!(roomy.gaps[0], SessionGap::unknown(2, 1));
        assert_eq!((roomy.gaps[1].after.as_str(), roomy.gaps[1].gap_s), ("00000001", Some(4_900.0)));
        let narrow = place(&[spans[0].clone(), spans[1].clone(), span(3, 10.0, Some(300.0))]);
        assert_eq!(begins_s(&narrow), [0.0, 150.0, 300.0], "in the middle of the room that there is");
    }

    #[test]
    fn a_clock_that_was_set_back_is_told_and_not_gone_by() {
        let spans = [span(1, 100.0, Some(0.0)), span(2, 100.0, Some(-500.0)), span(3, 100.0, Some(-300.0))];
        let placement = place(&spans);
        assert_eq!(begins_s(&placement), [0.0, 1_100.0, 1_300.0], "the third by the second's clock");
        assert_eq!(placement.gaps[0].gap_s, None);
        assert!((placement.gaps[0].clock_goes_back_s.unwrap() - 600.2).abs() < 1e-3, "{:?}", placement.gaps);
        assert!((placement.gaps[1].gap_s.unwrap() - 100.0).abs() < 1e-3);
    }

    #[test]
    fn clocks_that_contradict_each_other_within_their_errors_do_not_go_back() {
        let placement = place(&[span(1, 100.0, Some(0.0)), span(2, 100.0, Some(100.15))]);
        assert_eq!(begins_s(&placement), [0.0, 100.2]);
        assert_eq!(placement.gaps[0].clock_goes_back_s, None);
    }
}
