//! Which line a row belongs to: as the recording says, else straight legs, found from the course.

use std::ops::Range;
use std::sync::Arc;

use super::moving_mean::moving_mean;
use super::track::Track;
use crate::tow::Tow;

/// The course is averaged over twice this, s: the yaw of a body in swell takes up to 10 s.
const COURSE_HALF_S: f64 = 5.0;
/// Rows of a leg keep its course within this, degrees: helmsmen and currents stay below it, a turn passes it within seconds.
const WITHIN_DEG: f64 = 20.0;
/// And of the middle's within this at its ends, where a turn begins, degrees.
const END_WITHIN_DEG: f64 = 10.0;
/// A leg's course turns less than this from end to end, degrees: a steady turn fills all of both sides of the middle, 20.
const LARGEST_DRIFT_DEG: f64 = 15.0;
/// A leg is at least as long, s. Shorter ones have no background of their own, which is slower than 100 s; half of that.
const SHORTEST_S: f64 = 50.0;
/// A course over ground means something above this speed, m/s: noise of positions makes 0.1.
const SLOWEST_M_PER_S: f64 = 0.3;
/// A longer step ends a leg, s.
const LONGEST_STEP_S: f64 = 10.0;

/// The line of each row; empty between lines. Lines that are found are numbered from `found` on, which grows.
pub(crate) fn lines(tow: &Tow, track: Option<&Track>, found: &mut usize) -> Vec<Arc<str>> {
    if let Some(line) = tow.line.as_ref().filter(|line| line.iter().any(|name| !name.is_empty())) {
        return line.clone();
    }
    let none: Arc<str> = "".into();
    let mut line = vec![none; tow.len()];
    let Some(course_deg) = courses(tow, track) else { return line };
    for leg in legs(&tow.time_s, &course_deg) {
        *found += 1;
        let name: Arc<str> = format!("L{found}").into();
        line[leg].fill(name);
    }
    line
}

/// The course of each row, degrees; NaN where there is none. Over ground where positions are known, else the heading.
fn courses(tow: &Tow, track: Option<&Track>) -> Option<Vec<f64>> {
    let over_ground = track.filter(|track| track.course_deg.iter().any(|course| course.is_finite())).map(|track| {
        let is_fast = |(course, speed): (&f64, &f64)| if *speed >= SLOWEST_M_PER_S { *course } else { f64::NAN };
        track.course_deg.iter().zip(&track.speed_m_per_s).map(is_fast).collect::<Vec<f64>>()
    });
    let course_deg = over_ground.or_else(|| tow.heading_deg.clone())?;
    let [east, north] = [f64::sin, f64::cos].map(|part: fn(f64) -> f64| {
        let parts: Vec<f64> = course_deg.iter().map(|degrees| part(degrees.to_radians())).collect();
        moving_mean(&tow.time_s, &parts, COURSE_HALF_S)
    });
    let mean = east.iter().zip(&north).map(|(east, north)| east.atan2(*north).to_degrees());
    Some(mean.zip(&course_deg).map(|(mean, course)| if course.is_nan() { f64::NAN } else { mean }).collect())
}

/// Straight legs. Rows without a course or a time, of which there may be some between the others, belong to the leg around
/// them.
fn legs(time_s: &[f64], course_deg: &[f64]) -> Vec<Range<usize>> {
    let mut legs = Vec::new();
    let (mut leg, mut before_s) = (Leg::default(), f64::NAN);
    for (row, course) in course_deg.iter().enumerate().filter(|(_, course)| course.is_finite()) {
        let is_gap = time_s[row] - before_s > LONGEST_STEP_S;
        if is_gap || !leg.takes(*course) {
            legs.extend(std::mem::replace(&mut leg, Leg::new(row)).finished(time_s, course_deg));
        }
        leg.add(row, *course);
        before_s = time_s[row];
    }
    legs.extend(leg.finished(time_s, course_deg));
    legs
}

/// A leg that grows row by row.
#[derive(Default)]
struct Leg {
    rows: Range<usize>,
    /// Sum of the unit vectors of its courses.
    sum: [f64; 2],
}

impl Leg {
    fn new(row: usize) -> Self {
        Self { rows: row..row, sum: [0.0; 2] }
    }

    /// Whether a row keeps the leg's mean course.
    fn takes(&self, course_deg: f64) -> bool {
        self.rows.is_empty() || difference_deg(course_deg, self.mean_deg()).abs() <= WITHIN_DEG
    }

    fn mean_deg(&self) -> f64 {
        self.sum[0].atan2(self.sum[1]).to_degrees()
    }

    fn add(&mut self, row: usize, course_deg: f64) {
        if self.rows.is_empty() {
            self.rows.start = row;
        }
        let (east, north) = course_deg.to_radians().sin_cos();
        if course_deg.is_finite() {
            self.sum = [self.sum[0] + east, self.sum[1] + north];
        }
        self.rows.end = row + 1;
    }

    /// Without the ends of the turns before and after it, if it is long enough then; a slow turn is no leg.
    fn finished(self, time_s: &[f64], course_deg: &[f64]) -> Option<Range<usize>> {
        let (quarter, Range { start, end }) = (self.rows.len() / 4, self.rows);
        let mut middle = Self::new(start + quarter);
        (start + quarter..end - quarter).for_each(|row| middle.add(row, course_deg[row]));
        let is_on = |row: &usize| difference_deg(course_deg[*row], middle.mean_deg()).abs() <= END_WITHIN_DEG;
        let (first, last) = ((start..end).find(is_on)?, (start..end).rev().find(is_on)?);
        let is_long = time_s[last] - time_s[first] >= SHORTEST_S;
        (is_long && drift_deg(&course_deg[first..=last]) < LARGEST_DRIFT_DEG).then_some(first..last + 1)
    }
}

/// By how much the course turns from the first half to the second, twice: what a steady turn makes from end to end.
fn drift_deg(course_deg: &[f64]) -> f64 {
    let halves = course_deg.split_at(course_deg.len() / 2);
    let [first, second] = [halves.0, halves.1].map(|half| {
        let mut leg = Leg::new(0);
        half.iter().enumerate().for_each(|(row, course)| leg.add(row, *course));
        leg.mean_deg()
    });
    2.0 * difference_deg(second, first).abs()
}

/// From -180 to 180.
fn difference_deg(a: f64, b: f64) -> f64 {
    (a - b + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three legs of 200 s, 358, 178 and 358 degrees with a yaw of 8, and half turns of 60 s between them.
    fn tow() -> Tow {
        let course = |time_s: f64| match time_s {
            t if t < 200.0 => 358.0,
            t if t < 260.0 => 358.0 + 3.0 * (t - 200.0),
            t if t < 460.0 => 178.0,
            t if t < 520.0 => 178.0 - 3.0 * (t - 460.0),
            _ => -2.0,
        };
        let time_s: Vec<f64> = (0..7200).map(|row| f64::from(row) / 10.0).collect();
        let heading = |time_s: &f64| (course(*time_s) + 8.0 * (time_s * 0.9).sin()).rem_euclid(360.0);
        Tow { heading_deg: Some(time_s.iter().map(heading).collect()), time_s, ..Tow::default() }
    }

    #[test]
    fn legs_are_found_and_turns_are_not() {
        let tow = tow();
        let mut found = 0;
        let line = lines(&tow, None, &mut found);
        assert_eq!(found, 3);
        for (row, name) in
            [(50, "L1"), (1900, "L1"), (2300, ""), (2800, "L2"), (4500, "L2"), (4900, ""), (5400, "L3"), (7150, "L3")]
        {
            assert_eq!(&*line[row], name, "{row}");
        }
        let ends: Vec<usize> = (1..line.len()).filter(|&row| line[row] != line[row - 1]).collect();
        for (end, near) in ends.iter().zip([2000.0, 2600.0, 4600.0, 5200.0]) {
            assert!((*end as f64 - near).abs() < 100.0, "{ends:?}");
        }
    }

    #[test]
    fn a_circle_has_no_legs() {
        for seconds in [120.0, 360.0, 900.0] {
            let mut tow = tow();
            tow.heading_deg =
                Some(tow.time_s.iter().map(|time_s| (time_s * 360.0 / seconds).rem_euclid(360.0)).collect());
            let mut found = 0;
            lines(&tow, None, &mut found);
            assert_eq!(found, 0, "{seconds}");
        }
    }

    #[test]
    fn the_recordings_own_lines_go_first() {
        let mut tow = tow();
        let names: Vec<Arc<str>> = (0..7200).map(|row| if row < 3000 { "7".into() } else { "".into() }).collect();
        tow.line = Some(names.clone());
        let mut found = 4;
        assert_eq!((lines(&tow, None, &mut found), found), (names, 4));
        tow.line = Some(vec!["".into(); 7200]);
        lines(&tow, None, &mut found);
        assert_eq!(found, 7);
    }
}
