//! Scalar, compensated reading and residual over one time axis: zoom into one and the others follow.

use plotly::common::{Anchor, DashType, Font, Line, Visible};
use plotly::layout::{Annotation, Axis, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::background::{less_background, shown_range};
use super::base::{BEFORE_NAME, Chart, axis, drawn, layout, merge, plain};
use super::line::{in_pairs, trace};
use super::palette::{BEFORE, Look};
use super::time_scale::TimeScale;
use crate::collect::Envelope;
use crate::report::data::{Mark, ReportData};
use crate::run::{MethodResult, SETTLED_S};

/// An uncompensated signal this many times the quietest residual is switched off to begin with.
const DWARFS: f64 = 4.0;

/// A method that leaves this many times as much as the best is switched off to begin with: it would hide the targets.
const HIDES: f64 = 2.0;

/// Of a mark on the chart.
const MARK: &str = "#444444";

/// The chart of `data`, in the given looks.
pub(in crate::report) fn time(data: &ReportData, looks: &[Look]) -> Chart {
    let scale = TimeScale::of(data.utc_offset_s);
    let mut plot = Plot::new();
    let before = &data.uncompensated;
    let line = Line::new().color(BEFORE).width(1.2);
    plot.add_trace(trace(&before.scalar_nt, scale, 3).name("scalar reading").line(line.clone()));
    let visible = if dwarfs(data) { Visible::LegendOnly } else { Visible::True };
    plot.add_trace(trace(&before.band_passed_nt, scale, 4).name(BEFORE_NAME).visible(visible).line(line).y_axis("y3"));
    for (method, look) in loudest_first(data, looks) {
        add_method(&mut plot, scale, (method, look), hides(data, method));
    }
    let layout = layout()
        .x_axis(scale.axis().anchor("y3"))
        .y_axis(axis("scalar, nT").domain(&[0.76, 1.0]).separate_thousands(true).hover_format(",.2f").zero_line(false))
        .y_axis2(compensated_axis(data))
        .y_axis3(axis("residual, nT").domain(&[0.0, 0.28]).hover_format(".3f"))
        .shapes(data.marks.iter().map(|mark| mark_line(mark, scale)).collect())
        .annotations(data.marks.iter().map(|mark| mark_label(mark, scale)).collect());
    let mut also = scale.over(3);
    merge(&mut also, json!({"yaxis": {"exponentformat": "none"}}));
    plot.set_layout(layout);
    Chart::new("over-time", "Scalar, compensated reading and residual over time", 860, plot, also)
}

/// Whether the uncompensated channel would squeeze the best method into a line.
pub(in crate::report) fn dwarfs(data: &ReportData) -> bool {
    data.best().is_some_and(|best| data.uncompensated.std_nt > DWARFS * data.methods[best].std_after_nt)
}

/// Drawn in this order, the quietest line comes to lie on top.
fn loudest_first<'a>(data: &'a ReportData, looks: &'a [Look]) -> Vec<(&'a MethodResult, &'a Look)> {
    let mut order: Vec<_> = drawn(data, looks).collect();
    order.sort_by(|a, b| b.0.std_after_nt.total_cmp(&a.0.std_after_nt));
    order
}

/// Whether `method` is switched off to begin with.
fn hides(data: &ReportData, method: &MethodResult) -> bool {
    data.best().is_some_and(|best| method.std_after_nt > HIDES * data.methods[best].std_after_nt)
}

fn add_method(plot: &mut Plot, scale: TimeScale, (method, look): (&MethodResult, &Look), is_off: bool) {
    let visible = || if is_off { Visible::LegendOnly } else { Visible::True };
    let line = Line::new().color(look.colour).width(1.2).dash(look.dash.clone());
    let name = plain(&method.name);
    let both = |trace: Box<Scatter<f64, Option<f64>>>| trace.line(line.clone()).legend_group(&name).visible(visible());
    plot.add_trace(both(trace(&less_background(&method.compensated_nt), scale, 3)).name(&name).y_axis("y2"));
    let residual = both(trace(&method.residual_nt, scale, 4)).name(format!("{name}, residual"));
    plot.add_trace(residual.show_legend(false).y_axis("y3"));
}

/// On the scale of the best method once it has settled: the others, and its first minutes, may leave it.
fn compensated_axis(data: &ReportData) -> Axis {
    let axis = axis("compensated, nT").domain(&[0.33, 0.71]).hover_format(",.2f");
    let best = data.best().map(|best| less_background(&data.methods[best].compensated_nt));
    let range = best.and_then(|best| shown_range(&best, settled_s(&best)));
    match range.filter(|(low, high)| high > low) {
        Some((low, high)) => axis.range(vec![low, high]),
        None => axis,
    }
}

/// From where on a method has settled; from the first bin in a recording that ends before.
fn settled_s(envelope: &Envelope) -> f64 {
    let ends = envelope.bins.first().zip(envelope.bins.last());
    let settled_s = ends.map_or(0.0, |(first, _)| first.time_s + SETTLED_S);
    if ends.is_some_and(|(_, last)| last.time_s > settled_s) { settled_s } else { f64::NEG_INFINITY }
}

/// A line through all three charts.
fn mark_line(mark: &Mark, scale: TimeScale) -> Shape {
    Shape::new()
        .shape_type(ShapeType::Line)
        .layer(ShapeLayer::Below)
        .x_ref("x")
        .y_ref("paper")
        .x0(scale.x(mark.time_s))
        .x1(scale.x(mark.time_s))
        .y0(0.0)
        .y1(0.71)
        .line(ShapeLine::new().color(MARK).width(1.0).dash(DashType::Dot))
}

fn mark_label(mark: &Mark, scale: TimeScale) -> Annotation {
    Annotation::new()
        .x(scale.x(mark.time_s))
        .x_ref("x")
        .y(0.71)
        .y_ref("paper")
        .y_anchor(Anchor::Bottom)
        .show_arrow(false)
        .font(Font::new().size(12).color(MARK))
        .text(plain(&mark.label))
}

/// Stretch of time that two points of a line stand for, s; `None` when every sample is drawn.
pub(in crate::report) fn stretch_s(data: &ReportData) -> Option<f64> {
    let scalar = &data.uncompensated.scalar_nt;
    in_pairs(scalar).then_some(scalar.bin_width_s)
}
