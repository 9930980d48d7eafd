//! Variables made of others over time. None reaches across a gap: after one, each begins anew in the state in which it would be
//! had its input always been what it is there.

use std::ops::Range;

use towmag_effect_file::{Filter, FilterTime};

use super::course::{Course, own_grid};
use crate::effects::parts::between_rows;
use crate::effects::swell_induction::quadrature;
use crate::simulator::signals::{GAUSS_LEGENDRE, Grid, Segment, Signals};

/// Times that change nothing, s.
const NO_TIME_S: f64 = 1e-9;
/// Windows up to this are integrated by Gauss and Legendre's rule, as `averaging_window` does; longer ones by sums, s.
const SHORT_WINDOW_S: f64 = 1.0;
/// An interpolation on a grid needs so many points: a segment of one row has no dynamics.
const LEAST_POINTS: usize = 5;

/// The filter's time for values of the parameters, s.
fn time_s(time: FilterTime, parameters: &[f64]) -> f64 {
    match time {
        FilterTime::Fixed(time_s) => time_s,
        FilterTime::Parameter(index) => parameters[index],
    }
}

/// What a filter makes of a course.
pub(super) fn filtered<'a>(signals: &'a Signals, of: &Course<'_>, filter: Filter, parameters: &[f64]) -> Course<'a> {
    let mut rows = Vec::with_capacity(signals.len());
    let mut dense = of.dense.as_ref().filter(|_| filter != Filter::Hilbert).map(|_| Vec::new());
    for (index, segment) in signals.segments().iter().enumerate() {
        let of_rows = &of.rows[segment.epochs.clone()];
        let stretch = Stretch { signals, segment, grid: own_grid(signals, segment), rows: of_rows };
        let on_grid = of.dense.as_ref().map(|dense| &dense[index]).filter(|dense| dense.len() >= LEAST_POINTS);
        match (on_grid, filter) {
            (_, Filter::Hilbert) => rows.extend(quadrature(of_rows)),
            (Some(on_grid), _) => {
                let (at_rows, between) = stretch.on_grid(on_grid, filter, parameters);
                rows.extend(at_rows);
                dense.iter_mut().for_each(|dense| dense.push(between.clone()));
            }
            (None, _) => {
                rows.extend(stretch.at_rows(filter, parameters));
                // Too short for a course between the rows: what there was of it.
                let short = of.dense.as_ref().map(|dense| dense[index].clone()).unwrap_or_default();
                dense.iter_mut().for_each(|dense| dense.push(short.clone()));
            }
        }
    }
    Course { rows: rows.into(), dense }
}

/// A segment of the recording, and what is filtered at its rows.
struct Stretch<'a> {
    signals: &'a Signals,
    segment: &'a Segment,
    grid: Grid,
    rows: &'a [f64],
}

impl Stretch<'_> {
    fn times_s(&self) -> &[f64] {
        &self.signals.epochs_s()[self.segment.epochs.clone()]
    }

    /// A time within the segment.
    fn within(&self, time_s: f64) -> f64 {
        time_s.clamp(self.segment.span_s[0], self.segment.span_s[1])
    }

    /// At the rows, and on the points of the segment.
    fn on_grid(&self, on_grid: &[f64], filter: Filter, parameters: &[f64]) -> (Vec<f64>, Vec<f64>) {
        match filter {
            Filter::LowPass(time) => match time_s(time, parameters) {
                time_s if time_s < NO_TIME_S => (self.rows.to_vec(), on_grid.to_vec()),
                time_s => self.changed(on_grid, self.grid.low_pass(on_grid, time_s, 0..on_grid.len())),
            },
            Filter::Delay(time) => {
                let delay_s = time_s(time, parameters);
                self.sampled(|at_s| self.grid.at(on_grid, self.within(at_s - delay_s)))
            }
            Filter::Mean(time) => self.mean(on_grid, time_s(time, parameters)),
            Filter::Rate => {
                let vectors: Vec<[f64; 3]> = on_grid.iter().map(|&value| [value, 0.0, 0.0]).collect();
                let rate: Vec<f64> = self.grid.derivative(&vectors).into_iter().map(|v| v[0]).collect();
                (self.times_s().iter().map(|&time_s| self.grid.at(&rate, time_s)).collect(), rate)
            }
            Filter::Hilbert => (quadrature(self.rows), on_grid.to_vec()),
            Filter::Play(width) => self.changed(on_grid, played(on_grid, width)),
            Filter::Hold(width) => self.changed(on_grid, held(on_grid, width)),
        }
    }

    /// What changes is interpolated and not the values: those of the rows are known better.
    fn changed(&self, before: &[f64], after: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
        let change: Vec<f64> = after.iter().zip(before).map(|(after, before)| after - before).collect();
        let at = |(&time_s, &value): (&f64, &f64)| value + self.grid.at(&change, time_s);
        (self.times_s().iter().zip(self.rows).map(at).collect(), after)
    }

    /// A function of time.
    fn sampled(&self, of: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let at_rows = self.times_s().iter().map(|&time_s| of(time_s)).collect();
        (at_rows, (0..self.grid.len).map(|point| of(self.grid.time_s(point))).collect())
    }

    fn mean(&self, on_grid: &[f64], window_s: f64) -> (Vec<f64>, Vec<f64>) {
        if window_s < NO_TIME_S {
            return (self.rows.to_vec(), on_grid.to_vec());
        }
        let step_s = 1.0 / self.grid.rate_hz;
        let times_s: Vec<f64> = (0..on_grid.len()).map(|k| self.grid.start_s + step_s * k as f64).collect();
        let long = sums(&times_s, on_grid);
        let integral = |time_s: f64| extended(time_s, self.segment.span_s, on_grid, |at_s| self.grid.at(&long, at_s));
        let (mut rows, between) = self.sampled(|time_s| (integral(time_s) - integral(time_s - window_s)) / window_s);
        if window_s <= SHORT_WINDOW_S {
            let value = |at_s: f64| self.grid.at(on_grid, self.within(at_s));
            let gauss = |&time_s: &f64| {
                let middle_s = time_s - 0.5 * window_s;
                GAUSS_LEGENDRE.iter().map(|&(x, weight)| 0.5 * weight * value(middle_s + 0.5 * window_s * x)).sum()
            };
            rows = self.times_s().iter().map(gauss).collect();
        }
        (rows, between)
    }

    /// Of what is known at the rows alone: straight lines between them.
    fn at_rows(&self, filter: Filter, parameters: &[f64]) -> Vec<f64> {
        let (times_s, values) = (self.times_s(), self.rows);
        let ends_s = [times_s[0], times_s[times_s.len() - 1]];
        match filter {
            Filter::LowPass(time) => low_passed(times_s, values, time_s(time, parameters)),
            Filter::Delay(time) => {
                let delay_s = time_s(time, parameters);
                times_s.iter().map(|at_s| between_rows(times_s, values, at_s - delay_s)).collect()
            }
            Filter::Mean(time) if time_s(time, parameters) < NO_TIME_S => values.to_vec(),
            Filter::Mean(time) => {
                let window_s = time_s(time, parameters);
                let sums = sums(times_s, values);
                let integral = |at_s: f64| extended(at_s, ends_s, values, |at_s| between_rows(times_s, &sums, at_s));
                times_s.iter().map(|&at_s| (integral(at_s) - integral(at_s - window_s)) / window_s).collect()
            }
            Filter::Rate => (0..values.len()).map(|k| slope(times_s, values, neighbours(k, values.len()))).collect(),
            Filter::Hilbert => quadrature(values),
            Filter::Play(width) => played(values, width),
            Filter::Hold(width) => held(values, width),
        }
    }
}

/// What follows only once a play of this half width is taken up; it begins in its middle.
pub(crate) fn played(values: &[f64], width: f64) -> Vec<f64> {
    let mut at = values.first().copied().unwrap_or(0.0);
    let mut follow = |&x: &f64| {
        at = at.clamp(x - width, x + width);
        at
    };
    values.iter().map(&mut follow).collect()
}

/// What stays as it was until its input is further away than this width, and then jumps to it.
pub(crate) fn held(values: &[f64], width: f64) -> Vec<f64> {
    let mut at = values.first().copied().unwrap_or(0.0);
    let mut follow = |&x: &f64| {
        if (x - at).abs() > width {
            at = x;
        }
        at
    };
    values.iter().map(&mut follow).collect()
}

/// Integral from the first value to each, by trapezia.
fn sums(times_s: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    for (times, values) in times_s.windows(2).zip(values.windows(2)) {
        sum += 0.5 * (times[1] - times[0]) * (values[0] + values[1]);
        sums.push(sum);
    }
    sums
}

/// An integral beyond its ends, where the values stay as they are there.
fn extended(at_s: f64, [from_s, to_s]: [f64; 2], values: &[f64], within: impl Fn(f64) -> f64) -> f64 {
    let (first, last) = (values[0], values[values.len() - 1]);
    within(at_s.clamp(from_s, to_s)) + first * (at_s - from_s).min(0.0) + last * (at_s - to_s).max(0.0)
}

/// First-order low-pass of straight lines between values, exactly; in steady state at the first.
fn low_passed(times_s: &[f64], values: &[f64], time_constant_s: f64) -> Vec<f64> {
    if time_constant_s < NO_TIME_S {
        return values.to_vec();
    }
    let mut y = values[0];
    let mut passed = vec![y];
    for (times, x) in times_s.windows(2).zip(values.windows(2)) {
        let steps = (times[1] - times[0]) / time_constant_s;
        let keep = libm::exp(-steps);
        // What is added of the straight line's slope, over its rise.
        let of_rise = if steps > 0.0 { 1.0 - (1.0 - keep) / steps } else { 0.0 };
        y = keep * y + (1.0 - keep) * x[0] + of_rise * (x[1] - x[0]);
        passed.push(y);
    }
    passed
}

/// The rows on both sides, as far as there are.
fn neighbours(row: usize, rows: usize) -> Range<usize> {
    row.saturating_sub(1)..(row + 1).min(rows - 1)
}

fn slope(times_s: &[f64], values: &[f64], of: Range<usize>) -> f64 {
    let over_s = times_s[of.end] - times_s[of.start];
    if over_s > 0.0 { (values[of.end] - values[of.start]) / over_s } else { 0.0 }
}
