//! What lies between two sessions of a recording.

use std::fmt;

use serde::Serialize;

/// Between a session and one before it: a start of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SessionGap {
    /// The session that begins after it.
    pub session: String,
    /// The session from whose last epoch it is measured: the one before, or the last before whose time is known.
    pub after: String,
    /// From that epoch to the first of the session, s; `None` where nothing tells: then the two stand 1,000 s apart, or as
    /// far as there is room.
    pub gap_s: Option<f64>,
    /// By how much it may be off, s.
    pub gap_error_s: Option<f64>,
    /// By so much the session's clock would have it begin too early: it was set back, and is not gone by, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clock_goes_back_s: Option<f64>,
}

impl SessionGap {
    /// Both clocks tell.
    pub(super) fn known(session: u32, after: u32, gap_s: f64, error_s: f64) -> Self {
        let (gap_s, gap_error_s) = (Some(milliseconds(gap_s)), Some(milliseconds(error_s)));
        Self { gap_s, gap_error_s, ..Self::unknown(session, after) }
    }

    /// Nothing tells.
    pub(super) fn unknown(session: u32, after: u32) -> Self {
        let [session, after] = [session, after].map(|session| format!("{session:08x}"));
        Self { session, after, gap_s: None, gap_error_s: None, clock_goes_back_s: None }
    }

    /// The clock tells what cannot be.
    pub(super) fn backwards(session: u32, after: u32, by_s: f64) -> Self {
        Self { clock_goes_back_s: Some(milliseconds(by_s)), ..Self::unknown(session, after) }
    }
}

fn milliseconds(s: f64) -> f64 {
    (s * 1e3).round() / 1e3
}

impl fmt::Display for SessionGap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { session, after, .. } = self;
        match (self.gap_s, self.gap_error_s, self.clock_goes_back_s) {
            (Some(gap_s), Some(error_s), _) => {
                write!(f, "session {session} begins {gap_s:.3} s +- {error_s:.3} s after the end of session {after}")
            }
            (_, _, Some(by_s)) => write!(
                f,
                "session {session} begins by its clock {by_s:.3} s too early to come after session {after}: the clock was \
                 set back, the time between them is not known"
            ),
            _ => write!(f, "session {session} begins an unknown time after session {after}: no clock tells it"),
        }
    }
}
