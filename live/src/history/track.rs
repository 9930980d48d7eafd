//! Where the body was.

use serde::Serialize;

/// Points that are kept: a line of them is as smooth as a screen can show.
pub(super) const MOST_POINTS: usize = 4_000;

/// First distance between points, s.
const FIRST_STEP_S: f64 = 1.0;

/// A place and its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrackPoint {
    /// On the strip, s.
    pub time_s: f64,
    /// WGS 84, degrees.
    pub latitude_deg: f64,
    /// WGS 84, degrees.
    pub longitude_deg: f64,
}

/// Where the body was. When there is no more room every second point goes: the whole tow stays on it.
#[derive(Clone, Debug)]
pub struct Track {
    points: Vec<TrackPoint>,
    step_s: f64,
}

impl Default for Track {
    fn default() -> Self {
        Self { points: Vec::with_capacity(MOST_POINTS), step_s: FIRST_STEP_S }
    }
}

impl Track {
    /// Keep a point, unless it is too close to the one before.
    pub(super) fn push(&mut self, point: TrackPoint) {
        if self.points.last().is_some_and(|last| point.time_s - last.time_s < self.step_s) {
            return;
        }
        if self.points.len() == MOST_POINTS {
            let mut place = 0;
            self.points.retain(|_| {
                place += 1;
                place % 2 == 1
            });
            self.step_s *= 2.0;
        }
        self.points.push(point);
    }

    /// The points, oldest first.
    pub fn points(&self) -> impl Iterator<Item = &TrackPoint> {
        self.points.iter()
    }

    /// The points after a time, s.
    pub fn points_since(&self, since_s: f64) -> &[TrackPoint] {
        &self.points[self.points.partition_point(|point| point.time_s <= since_s)..]
    }

    /// The latest place at or before a time, s.
    pub fn place_at(&self, time_s: f64) -> Option<&TrackPoint> {
        let later = self.points.partition_point(|point| point.time_s <= time_s);
        self.points.get(later.checked_sub(1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_a_long_tow_stays_and_gets_coarser() {
        let mut track = Track::default();
        let point = |second: u32| TrackPoint {
            time_s: f64::from(second),
            latitude_deg: 54.0,
            longitude_deg: f64::from(second) * 1e-5,
        };
        (0..50_000).for_each(|second| track.push(point(second)));
        assert!(track.points.len() <= MOST_POINTS && track.points.len() > MOST_POINTS / 3);
        assert_eq!(track.points[0].time_s, 0.0);
        assert!(track.points.windows(2).all(|pair| (8.0..=32.0).contains(&(pair[1].time_s - pair[0].time_s))));
        assert!((49_900.0..=50_000.0).contains(&track.place_at(1e9).unwrap().time_s));
        assert_eq!(track.place_at(-1.0), None);
        assert!(track.points_since(49_000.0).iter().all(|point| point.time_s > 49_000.0));
    }
}
