//! Lines over time, long ones as the smallest and largest value of each stretch.

use plotly::Scatter;
use plotly::common::Mode;

use super::time_scale::TimeScale;
use crate::collect::Envelope;
use crate::text::number::rounded;

/// A line through the samples; where a bin holds several, through its smallest and its largest at their own times, which
/// keeps the shape when zoomed in. The page turns the pairs that it finds by `meta` into hover texts.
pub(super) fn trace(envelope: &Envelope, scale: TimeScale, decimals: i32) -> Box<Scatter<f64, Option<f64>>> {
    let pairs = in_pairs(envelope);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for bin in &envelope.bins {
        if bin.after_gap {
            x.push(scale.x(bin.time_s));
            y.push(None);
        }
        let mut ends = [(bin.min_at_s, bin.min), (bin.max_at_s, bin.max)];
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (time_s, value) in ends.into_iter().take(if pairs { 2 } else { 1 }) {
            x.push(scale.x(time_s));
            y.push(Some(rounded(value, decimals)));
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
    use serde_json::json;

    pub(in crate::report::chart) fn bin(min: (f64, f64), max: (f64, f64), after_gap: bool) -> Bin {
        let ((min_at_s, min), (max_at_s, max)) = (min, max);
        let time_s = min_at_s.min(max_at_s);
        Bin { time_s, min, min_at_s, max, max_at_s, mean: 0.5 * (min + max), count: 2, after_gap }
    }

    #[test]
    fn line_passes_the_extremes_in_order_of_time_and_breaks_at_a_gap() {
        let bins = vec![bin((0.1, 1.0), (0.3, 2.0), false), bin((5.2, 0.0), (5.1, 0.5), true)];
        let trace = trace(&Envelope { bin_width_s: 0.4, bins }, TimeScale::RECORDING, 3);
        let json: serde_json::Value = serde_json::from_str(&trace.to_json()).unwrap();
        assert_eq!(json["x"], json!([0.1, 0.3, 5.1, 5.1, 5.2]));
        assert_eq!(json["y"], json!([1.0, 2.0, null, 0.5, 0.0]));
        assert_eq!(json["meta"], "pairs");
    }
}
