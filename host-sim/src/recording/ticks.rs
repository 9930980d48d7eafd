//! From times to ticks of the 10 Hz grid.

use super::bad_rows::RowFault;
use super::error::BadInput;
use super::rate::{EPOCH_S, JITTER_S, TIME_ROUNDING_S};
use crate::message::number;

/// Ticks wrap; a gap of more than half their range could not be told from a step back.
const LONGEST_GAP_TICKS: f64 = i32::MAX as f64;

/// Where a row lies on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Epochs since the first row; wraps.
    pub tick: u32,
    /// Seconds since the last row with a time, when epochs are missing in between.
    pub gap_s: Option<f64>,
}

/// Counts ticks from row to row.
#[derive(Clone, Debug, Default)]
pub struct TickCounter {
    /// Tick of the next row, if it follows without a gap.
    next: u32,
    /// Time and tick of the last row that had a time.
    known: Option<(f64, u32)>,
    /// Rows since then that were passed over.
    passed_over: u32,
}

impl TickCounter {
    /// The next row. One without a time is taken to follow at once; the next time puts the count right.
    ///
    /// # Errors
    ///
    /// When the time does not come at least half an epoch after the last one.
    pub fn step(&mut self, time_s: Option<f64>) -> Result<Tick, BadInput> {
        let mut answer = Tick { tick: self.next, gap_s: None };
        if let Some(time_s) = time_s {
            if let Some((known_s, known_tick)) = self.known {
                let step_s = time_s - known_s;
                check(known_s, time_s, step_s)?;
                let rows = self.next.wrapping_sub(known_tick);
                let ticks = ticks(step_s, rows);
                answer.tick = known_tick.wrapping_add(ticks);
                // Times at both ends of what `f64` holds are further apart than it holds.
                answer.gap_s = (ticks > rows.saturating_add(self.passed_over)).then_some(step_s.min(f64::MAX));
            }
            self.known = Some((time_s, answer.tick));
            self.passed_over = 0;
        }
        self.next = answer.tick.wrapping_add(1);
        Ok(answer)
    }

    /// A row that has no place on the grid: one whose time is wrong. The rows after it stand where they would without it.
    pub fn pass_over(&mut self) -> Tick {
        self.passed_over = self.passed_over.saturating_add(1);
        Tick { tick: self.next, gap_s: None }
    }

    /// Time of the last row that had one.
    pub fn latest_s(&self) -> Option<f64> {
        self.known.map(|(time_s, _)| time_s)
    }
}

/// Epochs in a step of `step_s` that is `rows` rows long; more than one row when those between have no time.
fn ticks(step_s: f64, rows: u32) -> u32 {
    let longest_without_gap_s = EPOCH_S * f64::from(rows) + JITTER_S + TIME_ROUNDING_S;
    if step_s <= longest_without_gap_s {
        return rows;
    }
    let elapsed = (step_s / EPOCH_S).round().min(LONGEST_GAP_TICKS) as u32;
    elapsed.max(rows.saturating_add(1))
}

fn check(known_s: f64, time_s: f64, step_s: f64) -> Result<(), BadInput> {
    let fault = match step_s {
        s if s >= JITTER_S - TIME_ROUNDING_S => return Ok(()),
        s if s > 0.0 => RowFault::ShortStep,
        0.0 => RowFault::RepeatedTime,
        _ => RowFault::BackwardTime,
    };
    let (time, known) = (number(time_s), number(known_s));
    let what = match fault {
        RowFault::ShortStep => {
            format!("{time} comes less than 0.05 s after {known}: rows must be 0.1 s apart, give or take half of it")
        }
        _ => format!("{time} does not come after {known}: time must increase from row to row"),
    };
    Err(BadInput::of(b"time_s", what).in_row(fault))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks_of(times: &[Option<f64>]) -> Vec<(u32, Option<f64>)> {
        let mut counter = TickCounter::default();
        times.iter().map(|&time| counter.step(time).unwrap()).map(|t| (t.tick, t.gap_s)).collect()
    }

    #[test]
    fn steps_with_jitter_are_one_epoch_whatever_the_origin() {
        for origin in [0.0, -3.0, 86_400.0, 1.7e9] {
            let times = [0.0, 0.1, 0.15, 0.3, 0.4, 0.45].map(|t| Some(origin + t));
            let ticks = ticks_of(&times);
            assert_eq!(ticks, (0..6).map(|tick| (tick, None)).collect::<Vec<_>>(), "{origin}");
        }
    }

    #[test]
    fn a_gap_is_as_long_as_its_time_says_and_never_one_epoch() {
        assert_eq!(ticks_of(&[Some(0.0), Some(0.151)])[1], (2, Some(0.151)));
        assert_eq!(ticks_of(&[Some(0.0), Some(0.2), Some(0.3)])[2], (3, None));
        assert_eq!(ticks_of(&[Some(0.0), Some(60.0)])[1], (600, Some(60.0)));
        assert_eq!(ticks_of(&[Some(0.0), Some(1e30)])[1], (i32::MAX as u32, Some(1e30)));
        assert_eq!(ticks_of(&[Some(-f64::MAX), Some(f64::MAX)])[1], (i32::MAX as u32, Some(f64::MAX)));
    }

    #[test]
    fn ticks_wrap_and_go_on() {
        let times: Vec<_> = (0..5).map(|i| Some(f64::from(i) * 1e9)).collect();
        let ticks = ticks_of(&times);
        assert_eq!(ticks[4].0, 4u32.wrapping_mul(i32::MAX as u32));
    }

    #[test]
    fn rows_without_a_time_count_until_the_next_time_puts_it_right() {
        assert_eq!(ticks_of(&[None, None, Some(5.0)]), [(0, None), (1, None), (2, None)]);
        assert_eq!(ticks_of(&[Some(0.0), None, None, Some(0.3)])[3], (3, None));
        assert_eq!(ticks_of(&[Some(0.0), None, Some(0.5)])[2], (5, Some(0.5)));
        assert_eq!(ticks_of(&[Some(0.0), None, Some(0.5), Some(0.6)])[3], (6, None));
        assert_eq!(ticks_of(&[Some(0.0), None, None, Some(0.1), Some(0.2)])[4], (4, None));
    }

    #[test]
    fn rows_that_are_passed_over_shift_nothing() {
        let mut counter = TickCounter::default();
        let mut step = |time_s| counter.step(Some(time_s)).map(|tick| (tick.tick, tick.gap_s));
        assert_eq!((step(0.0).unwrap(), step(0.1).unwrap()), ((0, None), (1, None)));
        // One that is there twice, then one in the place of another.
        counter.pass_over();
        assert_eq!(counter.step(Some(0.2)).unwrap(), Tick { tick: 2, gap_s: None });
        counter.pass_over();
        assert_eq!(counter.step(Some(0.4)).unwrap(), Tick { tick: 4, gap_s: None });
        counter.pass_over();
        assert_eq!(counter.step(Some(0.7)).unwrap().gap_s.map(|gap_s| (gap_s * 10.0).round()), Some(3.0));
    }

    #[test]
    fn what_does_not_come_after_is_refused() {
        for (first, second, words) in [
            (12.3, 12.3, "12.3 does not come after 12.3"),
            (12.3, 12.2, "12.2 does not come after 12.3"),
            (12.3, 12.34, "12.34 comes less than 0.05 s after 12.3"),
        ] {
            let mut counter = TickCounter::default();
            counter.step(Some(first)).unwrap();
            counter.step(None).unwrap();
            let error = counter.step(Some(second)).unwrap_err();
            assert!(error.column.as_deref() == Some("time_s") && error.what.starts_with(words), "{error:?}");
        }
    }
}
