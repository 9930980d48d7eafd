//! Lines, thinned to what a screen can show.

use std::fmt::Write;

use super::Axis;

/// Width and height of a drawing area in its own units.
const UNITS: f64 = 10_000.0;

/// A chart: fills `plot.html`.
pub(in crate::report) struct Plot {
    /// What a screen reader says of it.
    pub(in crate::report) label: String,
    /// What is up, with its unit; above the chart.
    pub(in crate::report) title: &'static str,
    /// Class in the style sheet: how high.
    pub(in crate::report) class: &'static str,
    pub(in crate::report) x: Axis,
    pub(in crate::report) y: Axis,
    pub(in crate::report) lines: Vec<Line>,
    pub(in crate::report) marks: Vec<Mark>,
}

/// A line.
pub(in crate::report) struct Line {
    /// Its name where a value is read off.
    pub(in crate::report) name: &'static str,
    /// Its class in the style sheet.
    pub(in crate::report) class: &'static str,
    /// The path, from [`path`].
    pub(in crate::report) d: String,
}

/// A numbered place on the axis of x.
pub(in crate::report) struct Mark {
    /// From the left, percent.
    pub(in crate::report) percent: String,
    /// Which contact.
    pub(in crate::report) number: usize,
}

/// Through `points`, of which each of `columns` keeps the smallest and the largest, so that no spike is lost. The line
/// breaks where a value is no number and where x jumps by more than `gap`.
pub(in crate::report) fn path(
    points: impl Iterator<Item = (f64, f64)>,
    gap: f64,
    [x, y]: [&Axis; 2],
    columns: usize,
) -> String {
    let mut pen = Pen::default();
    let mut last: Option<(f64, usize)> = None;
    for (at, value) in points {
        if !value.is_finite() || !at.is_finite() {
            last = None;
            continue;
        }
        let column = (x.share(at).clamp(0.0, 1.0) * columns as f64) as usize;
        let breaks = last.is_none_or(|(before, _)| at - before > gap);
        if breaks || last.is_some_and(|(_, before)| before != column) {
            pen.flush();
        }
        if breaks {
            pen.is_down = false;
        }
        last = Some((at, column));
        pen.take((UNITS * x.share(at), UNITS * (1.0 - y.share(value))));
    }
    pen.flush();
    pen.d
}

#[derive(Default)]
struct Pen {
    d: String,
    is_down: bool,
    /// Lowest and highest of the column.
    ends: Option<[(f64, f64); 2]>,
}

impl Pen {
    fn take(&mut self, point: (f64, f64)) {
        let ends = self.ends.get_or_insert([point; 2]);
        if point.1 < ends[0].1 {
            ends[0] = point;
        }
        if point.1 > ends[1].1 {
            ends[1] = point;
        }
    }

    fn flush(&mut self) {
        let Some(mut ends) = self.ends.take() else { return };
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = if ends[0] == ends[1] { 1 } else { 2 };
        for (x, y) in ends.into_iter().take(count) {
            let before = if self.is_down { ' ' } else { 'M' };
            self.is_down = true;
            let _ = write!(self.d, "{before}{x:.0} {y:.0}"); // a text takes everything
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> [Axis; 2] {
        [Axis::numbers(0.0, 10.0, "s", 5), Axis::numbers(0.0, 1.0, "nT", 5)]
    }

    #[test]
    fn no_spike_is_lost_and_gaps_stay_open() {
        let [x, y] = axes();
        let points = (0..1000).map(|k| (0.01 * f64::from(k), if k == 523 { 1.0 } else { 0.5 }));
        let d = path(points, 0.1, [&x, &y], 20);
        assert!(d.contains("5230 0"), "{d}");
        assert!(d.split(' ').count() < 90 && d.matches('M').count() == 1, "{d}");
        let broken = [(0.0, 0.0), (1.0, f64::NAN), (2.0, 1.0), (3.0, 1.0), (9.0, 0.0)];
        assert_eq!(path(broken.into_iter(), 2.0, [&x, &y], 20), "M0 10000M2000 0 3000 0M9000 10000");
    }
}
