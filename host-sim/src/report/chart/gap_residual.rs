//! What the simulator leaves of each sensor, before and after the effects that were named, and where the targets are.

use plotly::common::{DashType, Line, Marker, MarkerSymbol, Mode};
use plotly::layout::{Axis, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Plot, Scatter};

use super::line::trace;
use super::spectrum::{Curve, curves, range};
use super::time_scale::TimeScale;
use super::{BEFORE, Chart, FLUXGATE, SCALAR, axis, layout};
use crate::diagnosis::TargetFound;
use crate::report::series::Series;
use crate::text::diagnosis_targets::peak;
use crate::text::number::rounded;

/// Without any effect, in every legend.
const BEFORE_NAME: &str = "before: without any effect";
/// Where no effect was named at all.
const ONLY_NAME: &str = "residual";
/// With the effects that were named.
const AFTER_NAME: &str = "after: with the named effects";
/// The noise that the simulator expects.
const NOISE_NAME: &str = "noise alone";
const NOISE: &str = "#000000";
/// Where a target is.
const TARGET: &str = FLUXGATE;

/// Both sensors over one time axis; `None` when there is nothing to draw.
pub(in crate::report) fn gap_residual(series: &[Series], targets: &[TargetFound]) -> Option<Chart> {
    if series.is_empty() {
        return None;
    }
    let mut plot = Plot::new();
    let mut shapes = Vec::new();
    for (index, sensor) in series.iter().enumerate() {
        add_lines(&mut plot, sensor, before_name(series), index, is_first_after(series, index));
        shapes.extend(noise_lines(sensor, index));
    }
    if !targets.is_empty() {
        plot.add_trace(target_marks(targets));
        shapes.extend(targets.iter().map(target_line));
    }
    let last = series.len();
    let anchor = if last == 1 { "y".into() } else { format!("y{last}") };
    let mut layout =
        layout().x_axis(TimeScale::RECORDING.axis().anchor(anchor)).shapes(shapes).y_axis(residual_axis(series, 0));
    if last > 1 {
        layout = layout.y_axis2(residual_axis(series, 1));
    }
    plot.set_layout(layout);
    let height_px = 120 + 270 * last;
    Some(Chart::new(
        "residual",
        "Residual before and after over time",
        height_px,
        plot,
        TimeScale::RECORDING.over(last),
    ))
}

fn residual_axis(series: &[Series], index: usize) -> Axis {
    let [low, high] = match (series.len(), index) {
        (1, _) => [0.0, 1.0],
        (_, 0) => [0.54, 1.0],
        _ => [0.0, 0.46],
    };
    axis(&format!("{} residual, nT", series[index].channel)).domain(&[low, high]).hover_format(".3f")
}

fn add_lines(plot: &mut Plot, sensor: &Series, before_name: &str, index: usize, is_first_after: bool) {
    let y_axis = if index == 0 { "y".into() } else { format!("y{}", index + 1) };
    let mut add = |envelope, name: &str, colour: &'static str, in_legend: bool| {
        let line = Line::new().color(colour).width(1.2);
        let line =
            trace(envelope, TimeScale::RECORDING, 4).name(name).legend_group(name).show_legend(in_legend).line(line);
        plot.add_trace(line.y_axis(&y_axis));
    };
    add(&sensor.before_nt, before_name, BEFORE, index == 0);
    if let Some(after_nt) = &sensor.after_nt {
        add(after_nt, AFTER_NAME, SCALAR, is_first_after);
    }
}

/// Each name stands in the legend once.
fn is_first_after(series: &[Series], index: usize) -> bool {
    series[..index].iter().all(|sensor| sensor.after_nt.is_none())
}

fn before_name(series: &[Series]) -> &'static str {
    if series.iter().any(|sensor| sensor.after_nt.is_some()) { BEFORE_NAME } else { ONLY_NAME }
}

/// Ends of what 95 % of the noise lies in.
fn noise_lines(sensor: &Series, index: usize) -> [Shape; 2] {
    [-2.0, 2.0].map(|sigmas| {
        Shape::new()
            .shape_type(ShapeType::Line)
            .layer(ShapeLayer::Above)
            .x_ref("paper")
            .y_ref(if index == 0 { "y".into() } else { format!("y{}", index + 1) })
            .x0(0.0)
            .x1(1.0)
            .y0(sigmas * sensor.noise_floor_nt)
            .y1(sigmas * sensor.noise_floor_nt)
            .line(ShapeLine::new().color(NOISE).width(1.5).dash(DashType::Dash))
    })
}

/// A mark at each target, in the middle of the first sensor's chart.
fn target_marks(targets: &[TargetFound]) -> Box<Scatter<f64, f64>> {
    let told = |target: &TargetFound| format!("{} nT, {:.1} s wide", peak(target), target.width_s);
    Scatter::new(targets.iter().map(|target| rounded(target.time_s, 1)).collect(), vec![0.0; targets.len()])
        .mode(Mode::Markers)
        .name("target")
        .marker(Marker::new().symbol(MarkerSymbol::TriangleUp).size(10).color(TARGET))
        .text_array(targets.iter().map(told).collect())
        .hover_template("%{text}")
}

/// A line through the charts of both sensors.
fn target_line(target: &TargetFound) -> Shape {
    Shape::new()
        .shape_type(ShapeType::Line)
        .layer(ShapeLayer::Below)
        .x_ref("x")
        .y_ref("paper")
        .x0(target.time_s)
        .x1(target.time_s)
        .y0(0.0)
        .y1(1.0)
        .line(ShapeLine::new().color(TARGET).width(1.0).dash(DashType::Dot))
}

/// One chart for each sensor of which there is a spectrum.
pub(in crate::report) fn gap_spectra(series: &[Series]) -> Vec<Chart> {
    series.iter().filter_map(|sensor| spectrum(sensor, before_name(series))).collect()
}

fn spectrum(sensor: &Series, before_name: &str) -> Option<Chart> {
    let mut all = vec![Curve {
        spectrum: &sensor.spectrum_before,
        name: before_name.into(),
        colour: BEFORE,
        dash: DashType::Solid,
    }];
    if sensor.after_nt.is_some() {
        let (spectrum, name) = (&sensor.spectrum_after, AFTER_NAME.into());
        all.push(Curve { spectrum, name, colour: SCALAR, dash: DashType::Solid });
    }
    let (spectrum, name) = (&sensor.spectrum_noise, NOISE_NAME.into());
    all.push(Curve { spectrum, name, colour: NOISE, dash: DashType::Dash });
    let range = range(all.iter().map(|curve| curve.spectrum))?;
    let id = format!("spectrum-{}", sensor.channel);
    Some(curves(&id, &format!("Amplitude spectrum of the {} residual", sensor.channel), &all, range, None))
}
