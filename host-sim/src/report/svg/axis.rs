//! An axis: from where to where, with its labels.

use super::ticks;

/// A label, at a share of the axis.
pub(in crate::report) struct Tick {
    /// From its low end, percent.
    pub(in crate::report) percent: String,
    /// What it says.
    pub(in crate::report) text: String,
}

/// From one value to another.
pub(in crate::report) struct Axis {
    /// Value at the left or the bottom.
    pub(in crate::report) low: f64,
    /// Value at the right or the top.
    pub(in crate::report) high: f64,
    /// Labels.
    pub(in crate::report) ticks: Vec<Tick>,
    /// After a value that is read off; empty for clock time.
    pub(in crate::report) unit: &'static str,
    /// What makes seconds since 1970 of a value, where the axis is clock time.
    pub(in crate::report) utc_offset_s: Option<f64>,
}

impl Axis {
    /// Of numbers, with at most about `most` labels.
    pub(in crate::report) fn numbers(low: f64, high: f64, unit: &'static str, most: usize) -> Self {
        Self::with(low, high, unit, None, ticks::numbers(low, high, most))
    }

    /// Of time: of the clock where `utc_offset_s` is known, else of the recording.
    pub(in crate::report) fn time(low_s: f64, high_s: f64, utc_offset_s: Option<f64>, most: usize) -> Self {
        match utc_offset_s {
            Some(offset_s) => Self::with(low_s, high_s, "", utc_offset_s, ticks::clocks(low_s, high_s, offset_s, most)),
            None => Self::numbers(low_s, high_s, "s", most),
        }
    }

    /// Around `values` with a margin; `None` where none is a number. A flat line has a range of its own.
    pub(in crate::report) fn around(
        values: impl Iterator<Item = f64>,
        unit: &'static str,
        most: usize,
    ) -> Option<Self> {
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let margin = if high > low { 0.06 * (high - low) } else { 0.5 + 1e-6 * high.abs() };
        (low <= high).then(|| Self::numbers(low - margin, high + margin, unit, most))
    }

    fn with(low: f64, high: f64, unit: &'static str, utc_offset_s: Option<f64>, ticks: Vec<(f64, String)>) -> Self {
        let percent = |value: f64| format!("{:.2}", 100.0 * (value - low) / (high - low));
        let ticks = ticks.into_iter().map(|(value, text)| Tick { percent: percent(value), text }).collect();
        Self { low, high, ticks, unit, utc_offset_s }
    }

    /// How far from the low end, 0 to 1.
    pub(in crate::report) fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}
