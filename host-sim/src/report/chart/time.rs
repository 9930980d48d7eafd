//! Scalar and residual over one time axis: zoom into one and the other follows.

use plotly::common::{Line, Visible};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::base::{BEFORE_NAME, Chart, axis, drawn, layout, merge, plain};
use super::line::{in_pairs, one_time_axis, time_axis, trace};
use super::palette::{BEFORE, Look};
use crate::collect::Envelope;
use crate::report::data::{ReportData, best};
use crate::run::MethodResult;
use crate::text::number::group;

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
        .x_axis(time_axis().anchor("y2"))
        .y_axis(axis("scalar, nT").domain(&[0.55, 1.0]).separate_thousands(true).hover_format(",.2f").zero_line(false))
        .y_axis2(axis("band-passed residual, nT").domain(&[0.0, 0.48]).hover_format(".3f"));
    let mut also = one_time_axis(2);
    merge(&mut also, json!({"yaxis": {"exponentformat": "none"}}));
    plot.set_layout(layout);
    Chart::new("over-time", "Scalar and band-passed residual over time", 680, plot, also)
}

/// Whether the uncompensated channel would squeeze the best method into a line.
pub(in crate::report) fn dwarfs(data: &ReportData) -> bool {
    best(&data.methods).is_some_and(|best| data.uncompensated.std_nt > DWARFS * data.methods[best].std_after_nt)
}

/// Drawn in this order, the quietest line comes to lie on top.
fn loudest_first<'a>(data: &'a ReportData, looks: &'a [Look]) -> Vec<(&'a MethodResult, &'a Look)> {
    let mut order: Vec<_> = drawn(data, looks).collect();
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

/// Stretch of time that two points of a line stand for, s; `None` when every sample is drawn.
pub(in crate::report) fn stretch_s(data: &ReportData) -> Option<f64> {
    let scalar = &data.uncompensated.scalar_nt;
    in_pairs(scalar).then_some(scalar.bin_width_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::line::tests::bin;

    #[test]
    fn only_a_far_level_is_moved() {
        let level = |nt: f64| Envelope { bin_width_s: 0.4, bins: vec![bin((0.0, nt - 10.0), (0.1, nt + 10.0), false)] };
        assert_eq!(shift(&level(50_000.0), &level(50_009.0)), 0.0);
        assert_eq!(shift(&level(50_000.0), &level(48_765.4)), 1_235.0);
    }
}
