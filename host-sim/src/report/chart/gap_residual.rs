//! What the simulator leaves of each sensor, before and after the effects that were named.

use plotly::Plot;
use plotly::common::{DashType, Line};
use plotly::layout::{Axis, Shape, ShapeLayer, ShapeLine, ShapeType};

use super::line::{one_time_axis, time_axis, trace};
use super::spectrum::{Curve, curves, range};
use super::{BEFORE, Chart, SCALAR, axis, layout};
use crate::report::series::Series;

/// Without any effect, in every legend.
const BEFORE_NAME: &str = "before: without any effect";
/// With the effects that were named.
const AFTER_NAME: &str = "after: with the named effects";
/// The noise that the simulator expects.
const NOISE_NAME: &str = "noise alone";
const NOISE: &str = "#000000";

/// Both sensors over one time axis; `None` when there is nothing to draw.
pub(in crate::report) fn gap_residual(series: &[Series]) -> Option<Chart> {
    if series.is_empty() {
        return None;
    }
    let mut plot = Plot::new();
    let mut shapes = Vec::new();
    for (index, sensor) in series.iter().enumerate() {
        add_lines(&mut plot, sensor, index);
        shapes.push(noise_band(sensor, index));
    }
    let last = series.len();
    let anchor = if last == 1 { "y".into() } else { format!("y{last}") };
    let mut layout = layout().x_axis(time_axis().anchor(anchor)).shapes(shapes).y_axis(residual_axis(series, 0));
    if last > 1 {
        layout = layout.y_axis2(residual_axis(series, 1));
    }
    plot.set_layout(layout);
    let height_px = 120 + 270 * last;
    Some(Chart::new("residual", "Residual before and after over time", height_px, plot, one_time_axis(last)))
}

fn residual_axis(series: &[Series], index: usize) -> Axis {
    let [low, high] = match (series.len(), index) {
        (1, _) => [0.0, 1.0],
        (_, 0) => [0.54, 1.0],
        _ => [0.0, 0.46],
    };
    axis(&format!("{} residual, nT", series[index].channel)).domain(&[low, high]).hover_format(".3f")
}

fn add_lines(plot: &mut Plot, sensor: &Series, index: usize) {
    let y_axis = if index == 0 { "y".into() } else { format!("y{}", index + 1) };
    let mut add = |envelope, name: &str, colour: &'static str| {
        let line = Line::new().color(colour).width(1.2);
        let line = trace(envelope, 0.0, 4).name(name).legend_group(name).show_legend(index == 0).line(line);
        plot.add_trace(line.y_axis(&y_axis));
    };
    add(&sensor.before_nt, BEFORE_NAME, BEFORE);
    if let Some(after_nt) = &sensor.after_nt {
        add(after_nt, AFTER_NAME, SCALAR);
    }
}

/// Where 95 % of the noise is.
fn noise_band(sensor: &Series, index: usize) -> Shape {
    let y_ref = if index == 0 { "y".into() } else { format!("y{}", index + 1) };
    Shape::new()
        .shape_type(ShapeType::Rect)
        .layer(ShapeLayer::Above)
        .x_ref("paper")
        .y_ref(y_ref)
        .x0(0.0)
        .x1(1.0)
        .y0(-2.0 * sensor.noise_floor_nt)
        .y1(2.0 * sensor.noise_floor_nt)
        .line(ShapeLine::new().color(NOISE).width(1.0).dash(DashType::Dash))
}

/// One chart for each sensor of which there is a spectrum.
pub(in crate::report) fn gap_spectra(series: &[Series]) -> Vec<Chart> {
    series.iter().filter_map(spectrum).collect()
}

fn spectrum(sensor: &Series) -> Option<Chart> {
    let mut all = vec![Curve {
        spectrum: &sensor.spectrum_before,
        name: BEFORE_NAME.into(),
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
