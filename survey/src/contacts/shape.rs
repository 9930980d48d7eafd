//! The shape of the way in space, and the Earth's field there.

use nalgebra::Vector3;

use super::levelled::{Levelled, RATE_HZ};
use crate::navigation::Track;
use crate::statistics::bell_sums;

/// Spread of the bell over which the heading of a rocked body is meant, s: of a rocking of 6.5 s it leaves 1.5 %, where a mean over 10 s,
/// which cuts turns as much, leaves a fifth.
const HEADING_S: f64 = 3.0;
/// The least part of the field across the vertical.
const LEAST_ACROSS: f64 = 0.1;

/// Where the body is in every row. Only the shape over some distances counts: a position that is off by the same for all of a pass
/// does not matter.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// East, north, down, m; finite everywhere.
    pub(super) places_m: Vec<Vector3<f64>>,
    /// Unit vector of the course, east and north.
    courses: Vec<[f64; 2]>,
    /// Unit vector of the Earth's field, east, north, down.
    pub(super) field: Vector3<f64>,
    /// Its size, nT.
    pub(super) field_nt: f64,
    /// Whether the way is that of positions.
    pub(super) is_track: bool,
}

impl Shape {
    /// `None` where nothing tells a course. `at_m` is the way of every row, `has_depth` whether it is in the unit of depths.
    pub(super) fn of(at_m: &[f64], levelled: &Levelled<'_>, has_depth: bool) -> Option<Self> {
        let by_track = levelled.track.and_then(|track| courses(&track.course_deg));
        let courses = by_track.or_else(|| headings(levelled.direction))?;
        let field = field(&courses, levelled.direction)?;
        let depth_m = levelled.depth_m.filter(|_| has_depth).and_then(carried);
        let depth_m = depth_m.map_or_else(|| vec![0.0; at_m.len()], Iterator::collect);
        let mut place = Vector3::zeros();
        let place_m = |row: usize| {
            if row > 0 {
                let [east, north] = courses[row];
                let on = [east, north].map(|part| part * (at_m[row] - at_m[row - 1]));
                let [east_m, north_m] = levelled.track.and_then(|track| step_m(track, row)).unwrap_or(on);
                place += Vector3::new(east_m, north_m, 0.0);
            }
            Vector3::new(place.x, place.y, depth_m[row])
        };
        let places_m = (0..at_m.len()).map(place_m).collect();
        let known = || levelled.field_nt.iter().filter(|nt| nt.is_finite());
        let field_nt = known().sum::<f64>() / known().count().max(1) as f64;
        let is_track = levelled.track.is_some_and(|track| track.easting_m.iter().any(|m| m.is_finite()));
        Some(Self { places_m, courses, field, field_nt, is_track })
    }

    /// Unit vectors forward and starboard of a row.
    pub(super) fn axes(&self, row: usize) -> [Vector3<f64>; 2] {
        let [east, north] = self.courses[row];
        [Vector3::new(east, north, 0.0), Vector3::new(north, -east, 0.0)]
    }
}

/// From the row before to a row, east and north, where both places are known.
pub(super) fn step_m(track: &Track, row: usize) -> Option<[f64; 2]> {
    let [east_m, north_m] =
        [&track.easting_m, &track.northing_m].map(|axis| Some(axis.get(row)? - axis.get(row.checked_sub(1)?)?));
    Some([east_m?, north_m?]).filter(|step_m| step_m.iter().all(|m| m.is_finite()))
}

fn courses(course_deg: &[f64]) -> Option<Vec<[f64; 2]>> {
    Some(carried(course_deg)?.map(|course_deg| course_deg.to_radians().sin_cos().into()).collect())
}

/// From magnetic north, as the fluxgate sees it on a body that is level on the mean of some seconds. `None` where the Earth's
/// field is too steep for that.
pub(super) fn headings(directions: &[[f64; 3]]) -> Option<Vec<[f64; 2]>> {
    let known = |[forward, starboard, _]: &[f64; 3]| {
        if forward.is_finite() && starboard.is_finite() { [*forward, *starboard, 1.0] } else { [0.0; 3] }
    };
    let known: Vec<[f64; 3]> = directions.iter().map(known).collect();
    let heading = |[forward, starboard, count]: [f64; 3]| {
        let size = forward.hypot(starboard);
        (size > LEAST_ACROSS * count && count > 0.0).then(|| [-starboard / size, forward / size])
    };
    bell_sums(&known, HEADING_S * RATE_HZ).map(heading).collect()
}

/// The mean of what the fluxgate sees, turned by the course: the body is level, and heads where it goes, on the mean.
fn field(courses: &[[f64; 2]], directions: &[[f64; 3]]) -> Option<Vector3<f64>> {
    let turned = |([east, north], [forward, starboard, down]): (&[f64; 2], &[f64; 3])| {
        Vector3::new(east * forward + north * starboard, north * forward - east * starboard, *down)
    };
    let known = courses.iter().zip(directions).map(turned).filter(|field| field.iter().all(|x| x.is_finite()));
    known.sum::<Vector3<f64>>().try_normalize(0.0)
}

/// In each row the last value that is known, at the beginning the first; `None` where none is.
fn carried(values: &[f64]) -> Option<impl Iterator<Item = f64>> {
    let mut last = *values.iter().find(|value| value.is_finite())?;
    Some(values.iter().map(move |value| {
        last = if value.is_finite() { *value } else { last };
        last
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heading_of_a_rocked_body_is_that_of_its_leg() {
        // To north, yawed by 17 degrees every 6.5 s; then a turn by a right angle in 15 s.
        let heading = |row: usize| ((row as f64 / RATE_HZ - 60.0) / 15.0).clamp(0.0, 1.0) * std::f64::consts::FRAC_PI_2;
        let yaw = |row: usize| 0.3 * (std::f64::consts::TAU * row as f64 / RATE_HZ / 6.5).sin();
        let seen = |row: usize| {
            let (sin, cos) = (heading(row) + yaw(row)).sin_cos();
            [0.6 * cos, -0.6 * sin, 0.8]
        };
        let found = headings(&(0..1_500).map(seen).collect::<Vec<_>>()).unwrap();
        let off_deg = |row: usize| {
            let [east, north] = found[row];
            (east.atan2(north) - heading(row)).to_degrees().abs()
        };
        let leg = (100..500).chain(900..1_400).map(off_deg).fold(0.0, f64::max);
        let turn = (500..900).map(off_deg).fold(0.0, f64::max);
        assert!(leg < 0.5 && turn < 10.0, "{leg} {turn}");
    }
}
