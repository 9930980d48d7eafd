//! One time axis for the sessions of a log.

use std::collections::HashMap;

use crate::recording::rate::RATE_HZ;

/// Where nothing tells how long the body was off between two sessions: seconds, more than any filter remembers.
const UNKNOWN_PAUSE_S: f64 = 1000.0;

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
    session: Option<u32>,
    /// Of each session whose time is known, the last that was told: tick and seconds since 1970-01-01 UTC.
    times: HashMap<u32, (u32, f64)>,
    /// Tick and time of the latest epoch or header of this session.
    latest: Option<(u32, f64)>,
    /// Time of the last epoch of any session, s.
    last_s: Option<f64>,
    tick: u32,
}

impl Timeline {
    /// For sessions whose times at these ticks were these, seconds since 1970-01-01 UTC.
    pub(super) fn new(times: HashMap<u32, (u32, f64)>) -> Self {
        Self { times, ..Self::default() }
    }

    pub(super) fn session(&mut self, session: u32) {
        if self.session.replace(session) != Some(session) {
            self.latest = None;
        }
    }

    /// Where the clock was set before the session or in it, its time goes by that, also before it was set.
    pub(super) fn header(&mut self, start_tick: u32, start_unix_ms: Option<u64>) {
        let set = self.session.and_then(|session| self.times.get(&session)).copied();
        let known = set.or(start_unix_ms.map(|unix_ms| (start_tick, unix_ms as f64 / 1000.0)));
        if let (None, Some((tick, unix_s))) = (self.latest, known) {
            let time_s = unix_s - f64::from(tick.saturating_sub(start_tick)) / RATE_HZ;
            self.latest = Some((start_tick, self.last_s.map_or(time_s, |last_s| time_s.max(last_s + 1.0))));
        }
    }

    /// Where an epoch lies on the one axis; `None` for one that does not come after the one before.
    pub(super) fn epoch(&mut self, tick: u32) -> Option<Place> {
        let (from, from_s) = self.latest.unwrap_or((tick, self.last_s.map_or(0.0, |s| s + UNKNOWN_PAUSE_S)));
        let ahead = tick.wrapping_sub(from);
        if ahead > u32::MAX / 2 {
            return None;
        }
        let time_s = ((from_s + f64::from(ahead) / RATE_HZ) * 1000.0).round() / 1000.0;
        let step_s = self.last_s.map(|last_s| time_s - last_s);
        if step_s.is_some_and(|step_s| step_s <= 0.0) {
            return None;
        }
        let gap_s = step_s.filter(|&step_s| step_s > 1.5 / RATE_HZ);
        self.tick = self.tick.wrapping_add(step_s.map_or(0, |step_s| (step_s * RATE_HZ).round().max(1.0) as u32));
        (self.latest, self.last_s) = (Some((tick, time_s)), Some(time_s));
        Some(Place { time_s, gap_s, tick: self.tick })
    }
}
