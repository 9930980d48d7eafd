//! The shape of the way in space, and the Earth's field there.

use nalgebra::Vector3;

use super::levelled::{Levelled, RATE_HZ};

/// Half of the time over which the heading of a rocked body is meant, s; and the least part of the field across the vertical.
const HEADING_S: f64 = 5.0;
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
                place += Vector3::new(east, north, 0.0) * (at_m[row] - at_m[row - 1]);
            }
            Vector3::new(place.x, place.y, depth_m[row])
        };
        let places_m = (0..at_m.len()).map(place_m).collect();
        Some(Self { places_m, courses, field })
    }

    /// Unit vectors forward and starboard of a row.
    pub(super) fn axes(&self, row: usize) -> [Vector3<f64>; 2] {
        let [east, north] = self.courses[row];
        [Vector3::new(east, north, 0.0), Vector3::new(north, -east, 0.0)]
    }
}

fn courses(course_deg: &[f64]) -> Option<Vec<[f64; 2]>> {
    Some(carried(course_deg)?.map(|course_deg| course_deg.to_radians().sin_cos().into()).collect())
}

/// From magnetic north, as the fluxgate sees it on a body that is level on the mean of some seconds. `None` where the Earth's
/// field is too steep for that.
fn headings(directions: &[[f64; 3]]) -> Option<Vec<[f64; 2]>> {
    let mut sums = vec![[0.0; 3]];
    for [forward, starboard, _] in directions {
        let [a, b, count] = sums[sums.len() - 1];
        let known = forward.is_finite() && starboard.is_finite();
        sums.push(if known { [a + forward, b + starboard, count + 1.0] } else { [a, b, count] });
    }
    let half = (HEADING_S * RATE_HZ) as usize;
    let mean = |row: usize| {
        let (from, to) = (sums[row.saturating_sub(half)], sums[(row + half + 1).min(directions.len())]);
        let [forward, starboard, count] = std::array::from_fn(|k| to[k] - from[k]);
        let size = forward.hypot(starboard);
        (size > LEAST_ACROSS * count && count > 0.0).then(|| [-starboard / size, forward / size])
    };
    (0..directions.len()).map(mean).collect()
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
