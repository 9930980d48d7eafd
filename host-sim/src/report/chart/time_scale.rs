//! Time across a chart: of the clock where the recording knows it, else its own seconds.

use plotly::layout::{Axis, AxisType};
use serde_json::{Value, json};

use super::base::{axis, merge};
use crate::text::number::rounded;

/// What makes seconds since 1970 of the recording's times, if anything.
#[derive(Clone, Copy)]
pub(super) struct TimeScale(Option<f64>);

impl TimeScale {
    /// The recording's own seconds.
    pub(super) const RECORDING: Self = Self(None);

    /// Of the clock where `utc_offset_s` is known.
    pub(super) fn of(utc_offset_s: Option<f64>) -> Self {
        Self(utc_offset_s)
    }

    /// As plotly.js takes it: seconds, or milliseconds since 1970.
    pub(super) fn x(self, time_s: f64) -> f64 {
        match self.0 {
            None => rounded(time_s, 3),
            Some(offset_s) => (1000.0 * (time_s + offset_s)).round(),
        }
    }

    /// The axis.
    pub(super) fn axis(self) -> Axis {
        match self.0 {
            None => axis("time in the recording, s").separate_thousands(true).hover_format(",.1f"),
            Some(_) => axis("UTC").type_(AxisType::Date).hover_format("%Y-%m-%d %H:%M:%S.%1f"),
        }
    }

    /// Layout of charts above one another on one axis of time: zoom into one and the others follow.
    pub(super) fn over(self, charts: usize) -> Value {
        let subplots: Vec<[String; 1]> =
            (1..=charts).map(|k| [if k == 1 { "xy".into() } else { format!("xy{k}") }]).collect();
        let mut layout = json!({
            "grid": {"rows": charts, "columns": 1, "subplots": subplots},
            "hoversubplots": "axis",
            "hoverdistance": -1,
        });
        if self.0.is_none() {
            let in_the_hover_label = json!({"exponentformat": "none", "ticksuffix": " s", "showticksuffix": "last"});
            merge(&mut layout, json!({ "xaxis": in_the_hover_label }));
        }
        layout
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_time_is_in_whole_milliseconds() {
        assert_eq!(TimeScale::of(Some(1_780_300_900.0)).x(0.1), 1_780_300_900_100.0);
        assert_eq!(TimeScale::RECORDING.x(0.123_456), 0.123);
        assert!(TimeScale::of(Some(0.0)).over(2).get("xaxis").is_none());
    }
}
