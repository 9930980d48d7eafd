//! Lines over time, long ones as the smallest and largest value of each stretch.

use plotly::Scatter;
use plotly::common::Mode;
use plotly::layout::Axis;
use serde_json::{Value, json};

use super::base::axis;
use crate::collect::Envelope;
use crate::text::number::rounded;

/// The axis of time.
pub(super) fn time_axis() -> Axis {
    axis("time in the recording, s").separate_thousands(true).hover_format(",.1f")
}

/// Layout of charts above one another on one time axis: zoom into one and the others follow.
pub(super) fn one_time_axis(charts: usize) -> Value {
    let subplots: Vec<[String; 1]> =
        (1..=charts).map(|k| [if k == 1 { "xy".into() } else { format!("xy{k}") }]).collect();
    json!({
        "grid": {"rows": charts, "columns": 1, "subplots": subplots},
        "hoversubplots": "axis",
        "hoverdistance": -1,
        "xaxis": {"exponentformat": "none", "ticksuffix": " s", "showticksuffix": "last"}, // in the hover label
    })
}

/// A line through the samples; where a bin holds several, through its smallest and its largest at their own times, which
/// keeps the shape when zoomed in. The page turns the pairs that it finds by `meta` into hover texts.
pub(super) fn trace(envelope: &Envelope, shift_nt: f64, decimals: i32) -> Box<Scatter<f64, Option<f64>>> {
    let pairs = in_pairs(envelope);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for bin in &envelope.bins {
        if bin.after_gap {
            x.push(rounded(bin.time_s, 3));
            y.push(None);
        }
        let mut ends = [(bin.min_at_s, bin.min), (bin.max_at_s, bin.max)];
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (time_s, value) in ends.into_iter().take(if pairs { 2 } else { 1 }) {
            x.push(rounded(time_s, 3));
            y.push(Some(rounded(value + shift_nt, decimals)));
        }
    }
    let trace = Scatter::new(x, y).mode(Mode::Lines).connect_gaps(false);
    if pairs { trace.meta("pairs") } else { trace }
}

/// Whether points stand for several samples.
pub(super) fn in_pairs(envelope: &Envelope) -> bool {
    envelope.bins.iter().any(|bin| bin.count > 1)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::collect::Bin;
    use plotly::Trace;

    pub(in crate::report::chart) fn bin(min: (f64, f64), max: (f64, f64), after_gap: bool) -> Bin {
        let ((min_at_s, min), (max_at_s, max)) = (min, max);
        let time_s = min_at_s.min(max_at_s);
        Bin { time_s, min, min_at_s, max, max_at_s, mean: 0.5 * (min + max), count: 2, after_gap }
    }

    #[test]
    fn line_passes_the_extremes_in_order_of_time_and_breaks_at_a_gap() {
        let bins = vec![bin((0.1, 1.0), (0.3, 2.0), false), bin((5.2, 0.0), (5.1, 0.5), true)];
        let trace = trace(&Envelope { bin_width_s: 0.4, bins }, 10.0, 3);
        let json: serde_json::Value = serde_json::from_str(&trace.to_json()).unwrap();
        assert_eq!(json["x"], json!([0.1, 0.3, 5.1, 5.1, 5.2]));
        assert_eq!(json["y"], json!([11.0, 12.0, null, 10.5, 10.0]));
        assert_eq!(json["meta"], "pairs");
    }
}
