//! Rows of the grid, each filtered from the readings around it.

use super::grid::Grid;
use super::low_pass::CUT_HZ;

/// So much of a stretch tells where it begins and ends, s: what lies beyond is mirrored there.
const END_S: f64 = 0.5;
/// A row needs this part of its filter's weight, else it has no value.
const NEEDED_SHARE: f64 = 0.6;

impl Grid<'_> {
    /// The filter around a row. Beyond the ends of a stretch its readings are mirrored through where it ends, so that a
    /// slope goes on as a slope.
    pub(super) fn filtered(&self, row: usize, numbers: &[f64], usable: impl Fn(usize) -> bool) -> f64 {
        let (time_s, stretch) = (self.time_s[row], &self.stretch[row]);
        let half_s = self.low_pass.half_s;
        let (begin_s, end_s) = (self.source_s[stretch.start], self.source_s[stretch.end - 1]);
        let mut sum = Sum::default();
        let mut add = |source: usize, off_s: f64, mirrored: Option<f64>| {
            let value = mirrored.map_or(numbers[source], |end| 2.0 * end - numbers[source]);
            let is_there = value.is_finite() && usable(source);
            sum.add(self.low_pass.weight(off_s), off_s, value, is_there);
        };
        let back = (stretch.start..=self.at[row]).rev();
        let forward = self.at[row] + 1..stretch.end;
        let within = |source: &usize| (self.source_s[*source] - time_s).abs() < half_s;
        for source in back.take_while(within).chain(forward.take_while(within)) {
            add(source, self.source_s[source] - time_s, None);
        }
        if time_s - begin_s < half_s {
            let end = self.end(numbers, stretch.clone(), begin_s);
            let image = |source: &usize| 2.0 * begin_s - self.source_s[*source] - time_s;
            for source in (stretch.start + 1..stretch.end).take_while(|source| image(source) > -half_s) {
                add(source, image(&source), Some(end));
            }
        }
        if end_s - time_s < half_s {
            let end = self.end(numbers, stretch.clone(), end_s);
            let image = |source: &usize| 2.0 * end_s - self.source_s[*source] - time_s;
            for source in (stretch.start..stretch.end - 1).rev().take_while(|source| image(source) < half_s) {
                add(source, image(&source), Some(end));
            }
        }
        sum.value()
    }

    /// Where the line through the readings next to an end of a stretch comes to that end.
    fn end(&self, numbers: &[f64], stretch: std::ops::Range<usize>, end_s: f64) -> f64 {
        let (mut count, mut t, mut tt, mut x, mut tx) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let near = self.nearest_rows(stretch, end_s);
        for source in near.filter(|&source| numbers[source].is_finite()) {
            let since = self.source_s[source] - end_s;
            (count, t, tt) = (count + 1.0, t + since, tt + since * since);
            (x, tx) = (x + numbers[source], tx + since * numbers[source]);
        }
        let spread = count * tt - t * t;
        if spread > 0.0 { (x * tt - t * tx) / spread } else { x / count }
    }

    fn nearest_rows(&self, stretch: std::ops::Range<usize>, end_s: f64) -> impl Iterator<Item = usize> {
        let is_begin = end_s == self.source_s[stretch.start];
        let len = stretch.len();
        (0..len)
            .map(move |at| if is_begin { stretch.start + at } else { stretch.start + len - 1 - at })
            .take_while(move |&source| (self.source_s[source] - end_s).abs() <= END_S)
    }

    pub(super) fn filtered_angle(&self, degrees: &[f64]) -> Vec<f64> {
        let (sines, cosines): (Vec<f64>, Vec<f64>) = degrees.iter().map(|angle| angle.to_radians().sin_cos()).unzip();
        let is_signed = degrees.iter().any(|angle| *angle < 0.0);
        let angle = |row| {
            let [sine, cosine] = [&sines, &cosines].map(|parts| self.filtered(row, parts, |_| true));
            let angle = sine.atan2(cosine).to_degrees();
            if is_signed || angle.is_nan() { angle } else { angle.rem_euclid(360.0) }
        };
        (0..self.time_s.len()).map(angle).collect()
    }
}

/// A weighted sum, and whether enough of it was there.
#[derive(Default)]
struct Sum {
    sum: f64,
    weights: f64,
    all: f64,
    near: f64,
    near_all: f64,
}

impl Sum {
    fn add(&mut self, weight: f64, off_s: f64, value: f64, is_there: bool) {
        let near = if off_s.abs() <= 0.5 / CUT_HZ { weight } else { 0.0 };
        self.all += weight;
        self.near_all += near;
        if is_there {
            self.sum += weight * value;
            self.weights += weight;
            self.near += near;
        }
    }

    fn value(&self) -> f64 {
        let enough = self.near > NEEDED_SHARE * self.near_all && self.weights > NEEDED_SHARE * self.all;
        if enough { self.sum / self.weights } else { f64::NAN }
    }
}
