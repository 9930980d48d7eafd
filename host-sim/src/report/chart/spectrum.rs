//! Amplitude spectrum of the residual: at which period something is left.

use plotly::common::{DashType, Line, Mode};
use plotly::layout::{AxisType, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::{BEFORE, BEFORE_NAME, Chart, Look, axis, layout, plain};
use crate::report::{ReportData, Spectrum};

/// Decades shown below the highest peak at most: what lies lower, the band-pass has removed.
const DECADES: f64 = 4.0;

/// The chart of `data`, in the given looks; `None` when the recording is too short for a spectrum.
pub(in crate::report) fn spectrum(data: &ReportData, looks: &[Look]) -> Option<Chart> {
    let methods = data.methods.iter().map(|method| &method.spectrum);
    let (bottom, top) = range(methods.chain([&data.uncompensated.spectrum]))?;
    let mut plot = Plot::new();
    plot.add_trace(trace(&data.uncompensated.spectrum, BEFORE_NAME, BEFORE, DashType::Dot));
    for (method, look) in super::drawn(data, looks) {
        plot.add_trace(trace(&method.spectrum, &plain(&method.name), look.colour, look.dash.clone()));
    }
    let layout = layout()
        .x_axis(axis("frequency, Hz").type_(AxisType::Log).hover_format(".3~r"))
        .y_axis(axis("residual, nT/√Hz").type_(AxisType::Log).hover_format(".3~r").range(vec![bottom, top]))
        .shapes(vec![band(data.band_hz)]);
    plot.set_layout(layout);
    let dtick = if top - bottom > 2.0 { json!(1) } else { json!("D2") };
    let also = json!({"xaxis": {"dtick": "D2", "tickformat": "~r", "ticksuffix": " Hz", "showticksuffix": "last"}, "yaxis": {"dtick": dtick, "exponentformat": "none"}});
    Some(Chart::new("spectrum", "Amplitude spectrum of the residual", 420, plot, also))
}

fn trace(spectrum: &Spectrum, name: &str, colour: &'static str, dash: DashType) -> Box<Scatter<f64, f64>> {
    // No zero on a logarithmic axis, and four digits are more than a screen shows.
    let points = spectrum.frequency_hz.iter().zip(&spectrum.density).filter(|(f, d)| **f > 0.0 && **d > 0.0);
    let (x, y) = points.map(|(f, d)| (four_digits(*f), four_digits(*d))).unzip();
    Scatter::new(x, y)
        .mode(Mode::Lines)
        .name(name)
        .hover_template("%{y} nT/√Hz")
        .line(Line::new().color(colour).width(2.0).dash(dash))
}

fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Range of the axis, in decades.
fn range<'a>(spectra: impl Iterator<Item = &'a Spectrum>) -> Option<(f64, f64)> {
    let positive = spectra.flat_map(|spectrum| spectrum.density.iter().skip(1)).copied().filter(|d| *d > 0.0);
    let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)));
    let top = high.log10() + 0.1;
    (high > 0.0).then(|| ((low.log10() - 0.1).max(top - DECADES), top))
}

/// The pass band, shaded.
fn band([low, high]: [f64; 2]) -> Shape {
    Shape::new()
        .shape_type(ShapeType::Rect)
        .layer(ShapeLayer::Below)
        .x_ref("x")
        .y_ref("paper")
        .x0(low)
        .x1(high)
        .y0(0.0)
        .y1(1.0)
        .fill_color("#F1F4F7")
        .line(ShapeLine::new().width(0.0))
}
