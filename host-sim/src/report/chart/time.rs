//! Scalar and residual over one time axis: zoom into one and the other follows.

use plotly::common::{Line, Mode, Visible};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::{BEFORE, BEFORE_NAME, Chart, Look, axis, layout, plain};
use crate::report::number::{group, rounded};
use crate::report::{Envelope, MethodResult, ReportData, best};

/// An uncompensated signal this many times the quietest residual is switched off to begin with.
const DWARFS: f64 = 4.0;

/// Share of the scalar's range beyond which a compensated scalar is drawn elsewhere than at its own level.
const FAR: f64 = 0.5;

/// The chart of `data`, in the given looks.
pub(in crate::report) fn time(data: &ReportData, looks: &[Look]) -> Chart {
    let mut plot = Plot::new();
    let before = &data.uncompensated;
    let line = Line::new().color(BEFORE).width(1.2);
    plot.add_trace(trace(&before.scalar_nt, 0.0, 3).name("scalar reading").line(line.clone()));
    let visible = if dwarfs(data) { Visible::LegendOnly } else { Visible::True };
    plot.add_trace(trace(&before.band_passed_nt, 0.0, 4).name(BEFORE_NAME).visible(visible).line(line).y_axis("y2"));
    for (method, look) in loudest_first(data, looks) {
        add_method(&mut plot, data, method, look);
    }
    let layout = layout()
        .x_axis(axis("time in the recording, s").separate_thousands(true).hover_format(",.1f").anchor("y2"))
        .y_axis(axis("scalar, nT").domain(&[0.55, 1.0]).separate_thousands(true).hover_format(",.2f").zero_line(false))
        .y_axis2(axis("band-passed residual, nT").domain(&[0.0, 0.48]).hover_format(".3f"));
    let also = json!({
        "grid": {"rows": 2, "columns": 1, "subplots": [["xy"], ["xy2"]]},
        "hoversubplots": "axis",
        "hoverdistance": -1,
        "xaxis": {"exponentformat": "none", "ticksuffix": " s", "showticksuffix": "last"}, // in the hover label
        "yaxis": {"exponentformat": "none"},
    });
    plot.set_layout(layout);
    Chart::new("over-time", "Scalar and band-passed residual over time", 680, plot, also)
}

/// Whether the uncompensated channel would squeeze the best method into a line.
pub(in crate::report) fn dwarfs(data: &ReportData) -> bool {
    best(&data.methods).is_some_and(|best| data.uncompensated.std_nt > DWARFS * data.methods[best].std_after_nt)
}

/// Drawn in this order, the quietest line comes to lie on top.
fn loudest_first<'a>(data: &'a ReportData, looks: &'a [Look]) -> Vec<(&'a MethodResult, &'a Look)> {
    let mut order: Vec<_> = super::drawn(data, looks).collect();
    order.sort_by(|a, b| b.0.std_after_nt.total_cmp(&a.0.std_after_nt));
    order
}

fn add_method(plot: &mut Plot, data: &ReportData, method: &MethodResult, look: &Look) {
    let line = Line::new().color(look.colour).width(1.2).dash(look.dash.clone());
    let shift_nt = shift(&data.uncompensated.scalar_nt, &method.compensated_nt);
    let name = plain(&method.name);
    let both = |trace: Box<Scatter<f64, Option<f64>>>| trace.line(line.clone()).legend_group(&name);
    plot.add_trace(both(trace(&method.compensated_nt, shift_nt, 3)).name(&name));
    let residual = both(trace(&method.residual_nt, 0.0, 4)).name(format!("{name}, residual"));
    plot.add_trace(residual.show_legend(false).y_axis("y2"));
}

/// Which scalars are drawn elsewhere than at their own level, and by how much, nT; `None` when none is.
pub(in crate::report) fn shifts(data: &ReportData) -> Option<String> {
    let moved = |method: &MethodResult| {
        let shift_nt = shift(&data.uncompensated.scalar_nt, &method.compensated_nt) as i64;
        let sign = if shift_nt > 0 { "+" } else { "" };
        (shift_nt != 0).then(|| format!("{} {sign}{}", method.name, group(shift_nt)))
    };
    let moved: Vec<String> = data.methods.iter().filter_map(moved).collect();
    (!moved.is_empty()).then(|| moved.join(", "))
}

/// How far to move a compensated scalar so that it can be compared with the reading: to the same mean, in whole nT, but
/// only when it would otherwise flatten the chart. Its level is arbitrary: the terms contain a constant.
fn shift(scalar: &Envelope, compensated: &Envelope) -> f64 {
    let (Some(from), Some(to), Some((low, high))) = (compensated.mean(), scalar.mean(), scalar.range()) else {
        return 0.0;
    };
    if (to - from).abs() > FAR * (high - low) { (to - from).round() } else { 0.0 }
}

/// A line through the samples; where a bin holds several, through its smallest and its largest at their own times, which
/// keeps the shape when zoomed in. The page turns the pairs that it finds by `meta` into hover texts.
fn trace(envelope: &Envelope, shift_nt: f64, decimals: i32) -> Box<Scatter<f64, Option<f64>>> {
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

fn in_pairs(envelope: &Envelope) -> bool {
    envelope.bins.iter().any(|bin| bin.count > 1)
}

/// Stretch of time that two points of a line stand for, s; `None` when every sample is drawn.
pub(in crate::report) fn stretch_s(data: &ReportData) -> Option<f64> {
    let scalar = &data.uncompensated.scalar_nt;
    in_pairs(scalar).then_some(scalar.bin_width_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Bin;
    use plotly::Trace;

    fn bin(min: (f64, f64), max: (f64, f64), after_gap: bool) -> Bin {
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

    #[test]
    fn only_a_far_level_is_moved() {
        let level = |nt: f64| Envelope { bin_width_s: 0.4, bins: vec![bin((0.0, nt - 10.0), (0.1, nt + 10.0), false)] };
        assert_eq!(shift(&level(50_000.0), &level(50_009.0)), 0.0);
        assert_eq!(shift(&level(50_000.0), &level(48_765.4)), 1_235.0);
    }
}
