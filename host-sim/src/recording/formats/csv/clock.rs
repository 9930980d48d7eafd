//! Which of two times is wrong when they do not fit, by a look at the row that follows; and midnight.

use crate::message::number;
use crate::recording::bad_rows::RowFault;
use crate::recording::error::BadInput;
use crate::recording::{LONGEST_STEP_S, TIME_ROUNDING_S};

/// From one midnight to the next, s.
const DAY_S: f64 = 86_400.0;

/// Longest gap across midnight, s: beyond it a step back is no midnight.
const LONGEST_AT_MIDNIGHT_S: f64 = 3_600.0;

/// Nobody counts seconds from so long ago: a number that stands for none.
const NO_TIME_S: f64 = 1e15;

/// What is made of a time.
pub(super) enum Judged {
    /// It may be right, s; days that have passed are in it.
    Time(f64),
    /// A day has passed since the row before, and is in it now.
    Midnight(f64),
    /// It is wrong.
    Wrong(BadInput),
}

/// Seconds of the days that have passed at midnights so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    days_s: f64,
}

impl Clock {
    /// The time of a row as it is written, after `before_s`. `next` gives the time of the row after it as it is written.
    pub(super) fn judge(
        &mut self,
        written_s: f64,
        before_s: Option<f64>,
        next: impl FnOnce() -> Option<f64>,
    ) -> Judged {
        let time_s = written_s + self.days_s;
        if written_s.abs() >= NO_TIME_S {
            return Judged::Wrong(wrong(format!("{} is no time", number(written_s))).in_row(RowFault::OutOfRange));
        }
        let step_s = before_s.map(|before_s| time_s - before_s);
        if step_s.is_some_and(|step_s| step_s > 0.0 && step_s <= LONGEST_STEP_S + TIME_ROUNDING_S) {
            return Judged::Time(time_s);
        }
        let next_s = next();
        match (before_s, next_s) {
            (Some(before_s), _) if is_midnight(time_s, before_s, written_s, next_s) => {
                self.days_s += DAY_S;
                Judged::Midnight(time_s + DAY_S)
            }
            (_, Some(next_s)) if self.is_ahead(time_s, before_s, next_s) => {
                let [time, next] = [written_s, next_s].map(number);
                let what = format!("{time} lies ahead of the rows around it: {next} follows");
                Judged::Wrong(wrong(what).in_row(RowFault::ForwardTime))
            }
            _ => Judged::Time(time_s),
        }
    }

    /// Whether the row after it goes on from the row before, as if this one were not there.
    fn is_ahead(self, time_s: f64, before_s: Option<f64>, next_s: f64) -> bool {
        let next_s = next_s + self.days_s;
        next_s < time_s && before_s.is_none_or(|before_s| before_s < next_s && before_s < time_s)
    }
}

fn wrong(what: String) -> BadInput {
    BadInput::of(b"time_s", what)
}

/// Whether the time of day has begun anew, and goes on from there.
fn is_midnight(time_s: f64, before_s: f64, written_s: f64, next_s: Option<f64>) -> bool {
    let across_s = time_s + DAY_S - before_s;
    let follows = |step_s: f64| step_s > 0.0 && step_s <= LONGEST_AT_MIDNIGHT_S;
    time_s < before_s && follows(across_s) && next_s.is_none_or(|next_s| follows(next_s - written_s))
}
