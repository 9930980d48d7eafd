//! Faster recordings at 10 Hz: filtered against aliases, without delay, gaps kept.

use std::sync::Arc;

use towmag_recording::{Column, ColumnKind};

use crate::draft::{Draft, DraftColumn, DraftValues};
use crate::rate::{RATE_HZ, Sampling};

/// Half of the power goes at this frequency, Hz; what the 10 Hz cannot show begins at 5.
const CUT_HZ: f64 = 4.5;
/// From the last frequency that passes to the first that is stopped, Hz: 4 to 5.
const TRANSITION_HZ: f64 = 1.0;
/// What is stopped is this much weaker, dB.
const STOPPED_DB: f64 = 90.0;
/// So much of a stretch tells where it begins and ends, s: what lies beyond is mirrored there.
const END_S: f64 = 0.5;
/// A row needs this part of its filter's weight, else it has no value.
const NEEDED_SHARE: f64 = 0.6;
/// A value that comes more rarely than the rows is led on for so many of its own steps, and no longer.
const LED_ON_STEPS: f64 = 1.5;

/// A low-pass of finite length, linear phase, centred: Kaiser's window over the ideal one (Kaiser 1974; Oppenheim and Schafer,
/// Discrete-Time Signal Processing, section 7.5.3).
#[derive(Clone, Debug)]
struct LowPass {
    half_s: f64,
    beta: f64,
    at_zero: f64,
}

impl LowPass {
    fn new() -> Self {
        let beta = 0.1102 * (STOPPED_DB - 8.7);
        let half_s = (STOPPED_DB - 7.95) / (14.36 * TRANSITION_HZ) / 2.0;
        Self { half_s, beta, at_zero: bessel_i0(beta) }
    }

    fn weight(&self, t_s: f64) -> f64 {
        let x = t_s / self.half_s;
        if x.abs() >= 1.0 {
            return 0.0;
        }
        let window = bessel_i0(self.beta * (1.0 - x * x).sqrt()) / self.at_zero;
        let phase = 2.0 * std::f64::consts::PI * CUT_HZ * t_s;
        let ideal = if phase == 0.0 { 1.0 } else { phase.sin() / phase };
        window * ideal
    }
}

/// The modified Bessel function of order 0, by its series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= quarter / f64::from(k * k);
        sum += term;
        if term < 1e-16 * sum {
            break;
        }
    }
    sum
}

/// The rows of a 10 Hz grid within the stretches of the source.
pub(crate) fn resample(draft: &Draft, sampling: &Sampling) -> Draft {
    let grid = Grid::of(&draft.time_s, sampling);
    let columns: Vec<DraftColumn> = draft.columns.iter().map(|column| grid.column(draft, column)).collect();
    let invalid = (0..grid.time_s.len()).map(|row| grid.nearby(row).any(|source| draft.invalid[source])).collect();
    Draft { time_s: grid.time_s, invalid, columns, ..*draft_head(draft) }
}

/// What stays the same.
fn draft_head(draft: &Draft) -> Box<Draft> {
    Box::new(Draft { is_utc: draft.is_utc, is_clock: draft.is_clock, ..Draft::default() })
}

/// Where the rows lie, and which rows of the source each is made of.
struct Grid<'a> {
    low_pass: LowPass,
    source_s: &'a [f64],
    time_s: Vec<f64>,
    /// The stretch of each row.
    stretch: Vec<std::ops::Range<usize>>,
    /// The row of the source at or before each.
    at: Vec<usize>,
}

impl<'a> Grid<'a> {
    fn of(source_s: &'a [f64], sampling: &Sampling) -> Self {
        let mut grid =
            Self { low_pass: LowPass::new(), source_s, time_s: Vec::new(), stretch: Vec::new(), at: Vec::new() };
        let Some(&first) = source_s.first() else { return grid };
        // On tenths of a second, so that stamps are short; by counting, so that none drifts.
        let origin = (first * RATE_HZ - 1e-6).ceil();
        for stretch in &sampling.stretches {
            let (begin, end) = (source_s[stretch.start], source_s[stretch.end - 1]);
            let mut count = (begin * RATE_HZ - origin - 1e-6).ceil().max(0.0);
            let mut at = stretch.start;
            while (origin + count) / RATE_HZ <= end + 1e-6 {
                let time_s = (origin + count) / RATE_HZ;
                while at + 1 < stretch.end && source_s[at + 1] <= time_s + 1e-9 {
                    at += 1;
                }
                grid.time_s.push(time_s);
                grid.stretch.push(stretch.clone());
                grid.at.push(at);
                count += 1.0;
            }
        }
        grid
    }

    /// The rows of the source within half a step of 10 Hz.
    fn nearby(&self, row: usize) -> impl Iterator<Item = usize> {
        let (time_s, stretch) = (self.time_s[row], self.stretch[row].clone());
        let is_near = move |source: &usize| (self.source_s[*source] - time_s).abs() <= 0.5 / RATE_HZ + 1e-9;
        let back = (stretch.start..=self.at[row]).rev().take_while(is_near);
        let forward = (self.at[row] + 1..stretch.end).take_while(is_near);
        back.chain(forward)
    }

    fn nearest(&self, row: usize) -> usize {
        let at = self.at[row];
        let next = (at + 1).min(self.stretch[row].end - 1);
        let off = |source: usize| (self.source_s[source] - self.time_s[row]).abs();
        if off(next) < off(at) { next } else { at }
    }

    fn column(&self, draft: &Draft, column: &DraftColumn) -> DraftColumn {
        let rows = 0..self.time_s.len();
        let values = match &column.values {
            DraftValues::Labels(labels) => {
                DraftValues::Labels(rows.map(|row| labels[self.nearest(row)].clone()).collect::<Vec<Arc<str>>>())
            }
            DraftValues::Numbers(numbers) => DraftValues::Numbers(match way(column, numbers) {
                Way::Nearest => rows.map(|row| numbers[self.nearest(row)]).collect(),
                Way::Lowest => rows.map(|row| self.lowest(row, numbers)).collect(),
                Way::LedOn => self.led_on(numbers),
                Way::Filtered => {
                    let usable = |source: usize| !draft.invalid[source] || column.known != Some(Column::Scalar);
                    rows.map(|row| self.filtered(row, numbers, usable)).collect()
                }
                Way::FilteredAngle => self.filtered_angle(numbers),
            }),
        };
        DraftColumn { values, is_made: true, ..column.clone() }
    }

    /// The filter around a row. Beyond the ends of a stretch its readings are mirrored through where it ends, so that a
    /// slope goes on as a slope.
    fn filtered(&self, row: usize, numbers: &[f64], usable: impl Fn(usize) -> bool) -> f64 {
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

    fn filtered_angle(&self, degrees: &[f64]) -> Vec<f64> {
        let (sines, cosines): (Vec<f64>, Vec<f64>) = degrees.iter().map(|angle| angle.to_radians().sin_cos()).unzip();
        let is_signed = degrees.iter().any(|angle| *angle < 0.0);
        let angle = |row| {
            let [sine, cosine] = [&sines, &cosines].map(|parts| self.filtered(row, parts, |_| true));
            let angle = sine.atan2(cosine).to_degrees();
            if is_signed || angle.is_nan() { angle } else { angle.rem_euclid(360.0) }
        };
        (0..self.time_s.len()).map(angle).collect()
    }

    fn lowest(&self, row: usize, numbers: &[f64]) -> f64 {
        let lowest = self.nearby(row).map(|source| numbers[source]).fold(f64::NAN, f64::min);
        if lowest.is_nan() { numbers[self.nearest(row)] } else { lowest }
    }

    /// Straight between the values that are there.
    fn led_on(&self, numbers: &[f64]) -> Vec<f64> {
        let there: Vec<usize> = (0..numbers.len()).filter(|&row| numbers[row].is_finite()).collect();
        let mut steps: Vec<f64> =
            there.windows(2).map(|pair| self.source_s[pair[1]] - self.source_s[pair[0]]).collect();
        let middle = steps.len() / 2;
        let usual_s = if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let longest_s = LED_ON_STEPS * usual_s.max(1.0 / RATE_HZ);
        let mut next = 0;
        let value = |time_s: f64| {
            while next < there.len() && self.source_s[there[next]] < time_s - 1e-9 {
                next += 1;
            }
            let after = there.get(next).copied();
            let before = next.checked_sub(1).map(|at| there[at]);
            match (before, after) {
                (_, Some(after)) if (self.source_s[after] - time_s).abs() <= 1e-9 => numbers[after],
                (Some(before), Some(after)) if self.source_s[after] - self.source_s[before] <= 2.0 * longest_s => {
                    let share = (time_s - self.source_s[before]) / (self.source_s[after] - self.source_s[before]);
                    numbers[before] + share * (numbers[after] - numbers[before])
                }
                (Some(before), _) if time_s - self.source_s[before] <= longest_s => numbers[before],
                (_, Some(after)) if self.source_s[after] - time_s <= longest_s => numbers[after],
                _ => f64::NAN,
            }
        };
        self.time_s.iter().copied().map(value).collect()
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

/// How the rows of a column become fewer.
enum Way {
    Nearest,
    Lowest,
    LedOn,
    Filtered,
    FilteredAngle,
}

fn way(column: &DraftColumn, numbers: &[f64]) -> Way {
    let present = numbers.iter().filter(|number| number.is_finite()).count();
    match column.known {
        Some(known) if known.spec().kind == ColumnKind::Flag => Way::Lowest,
        _ if present * 10 < numbers.len() * 7 => Way::LedOn,
        Some(Column::Heading | Column::Roll) => Way::FilteredAngle,
        Some(_) => Way::Filtered,
        None if column.name.starts_with("current_") => Way::Filtered,
        // Nobody knows what it is: a counter must stay one.
        None => Way::Nearest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resampled(rate_hz: f64, signal: impl Fn(f64) -> f64, spoil: impl Fn(usize, &mut Draft)) -> Draft {
        let time_s: Vec<f64> = (0..(60.0 * rate_hz) as usize).map(|row| row as f64 / rate_hz).collect();
        let numbers = time_s.iter().map(|t| signal(*t)).collect();
        let column = DraftColumn {
            name: "scalar_nT".into(),
            known: Some(Column::Scalar),
            values: DraftValues::Numbers(numbers),
            is_made: false,
        };
        let mut draft = Draft { invalid: vec![false; time_s.len()], time_s, columns: vec![column], ..Draft::default() };
        (0..draft.len()).for_each(|row| spoil(row, &mut draft));
        let sampling = Sampling::of(&draft.time_s).unwrap();
        resample(&draft, &sampling)
    }

    /// Largest difference from a signal, 3 s from the ends on.
    fn off(draft: &Draft, signal: impl Fn(f64) -> f64) -> f64 {
        let numbers = draft.numbers(Column::Scalar).unwrap();
        let inner = (0..draft.len()).filter(|&row| (3.0..57.0).contains(&draft.time_s[row]));
        inner.map(|row| (numbers[row] - signal(draft.time_s[row])).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn what_is_slow_passes_without_delay_and_what_is_fast_is_gone() {
        for rate_hz in [20.0, 40.0, 100.0, 160.0, 1000.0] {
            let slow = |t: f64| 50_000.0 + 10.0 * (2.0 * t).sin() + 3.0 * (24.0 * t).cos();
            let draft = resampled(rate_hz, slow, |_, _| {});
            assert!(off(&draft, slow) < 1e-3, "{rate_hz}: {}", off(&draft, slow));
            assert!((draft.time_s[1] - 0.1).abs() < 1e-12 && draft.len() >= 599);
            for tone_hz in [5.1, 6.0, 8.0, 9.9, 0.45 * rate_hz].into_iter().filter(|hz| *hz < rate_hz / 2.0) {
                let tone = |t: f64| 50_000.0 + 10.0 * (2.0 * std::f64::consts::PI * tone_hz * t).sin();
                let alias = off(&resampled(rate_hz, tone, |_, _| {}), |_| 50_000.0);
                assert!(alias < 1e-3, "{tone_hz} Hz at {rate_hz}: {alias}");
            }
        }
    }

    #[test]
    fn gaps_stay_and_what_is_invalid_is_left_out() {
        let draft = resampled(
            100.0,
            |_| 50_000.0,
            |row, draft| {
                if row >= 3000 {
                    draft.time_s[row] += 7.0;
                }
                if (1000..1030).contains(&row) {
                    draft.invalid[row] = true;
                    if let DraftValues::Numbers(numbers) = &mut draft.columns[0].values {
                        numbers[row] = 99_999.0;
                    }
                }
            },
        );
        assert!(draft.time_s.iter().all(|t| !(30.1..36.9).contains(t)));
        let scalar = draft.numbers(Column::Scalar).unwrap();
        assert!(scalar.iter().all(|value| value.is_nan() || (value - 50_000.0).abs() < 1e-6));
        let invalid = draft.invalid.iter().filter(|invalid| **invalid).count();
        assert!((3..=5).contains(&invalid), "{invalid}");
    }
}
