//! Amplitude spectrum of the residual: at which period something is left.

use plotly::common::{DashType, Line, Mode};
use plotly::layout::{AxisType, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::base::{BEFORE_NAME, Chart, axis, drawn, layout, plain};
use super::palette::{BEFORE, Look};
use crate::collect::AmplitudeSpectrum;
use crate::report::data::ReportData;

/// Decades shown below the highest peak at most: what lies lower, the band-pass has removed.
const DECADES: f64 = 4.0;

/// A line of the chart.
pub(super) struct Curve<'a> {
    pub(super) spectrum: &'a AmplitudeSpectrum,
    pub(super) name: String,
    pub(super) colour: &'static str,
    pub(super) dash: DashType,
}

/// The chart of `data`, in the given looks; `None` when the recording is too short for a spectrum.
pub(in crate::report) fn spectrum(data: &ReportData, looks: &[Look]) -> Option<Chart> {
    let (spectrum, name) = (&data.uncompensated.spectrum, BEFORE_NAME.into());
    let mut all = vec![Curve { spectrum, name, colour: BEFORE, dash: DashType::Dot }];
    all.extend(drawn(data, looks).map(|(method, look)| Curve {
        spectrum: &method.spectrum,
        name: plain(&method.name),
        colour: look.colour,
        dash: look.dash.clone(),
    }));
    // A method without a line still has its say in the range.
    let methods = data.methods.iter().map(|method| &method.spectrum);
    let range = range(methods.chain([&data.uncompensated.spectrum]))?;
    Some(curves("spectrum", "Amplitude spectrum of the residual", &all, range, Some(data.band_hz)))
}

/// Amplitude spectra on logarithmic axes, the pass band shaded.
pub(super) fn curves(
    id: &str,
    label: &str,
    curves: &[Curve<'_>],
    range: (f64, f64),
    band_hz: Option<[f64; 2]>,
) -> Chart {
    let (bottom, top) = range;
    let mut plot = Plot::new();
    for curve in curves {
        plot.add_trace(trace(curve));
    }
    let layout = layout()
        .x_axis(axis("frequency, Hz").type_(AxisType::Log).hover_format(".3~r"))
        .y_axis(axis("residual, nT/√Hz").type_(AxisType::Log).hover_format(".3~r").range(vec![bottom, top]))
        .shapes(band_hz.map(band).into_iter().collect());
    plot.set_layout(layout);
    let dtick = if top - bottom > 2.0 { json!(1) } else { json!("D2") };
    let also = json!({"xaxis": {"dtick": "D2", "tickformat": "~r", "ticksuffix": " Hz", "showticksuffix": "last"}, "yaxis": {"dtick": dtick, "tickformat": "~r"}});
    Chart::new(id, label, 420, plot, also)
}

fn trace(curve: &Curve<'_>) -> Box<Scatter<f64, f64>> {
    let spectrum = curve.spectrum;
    // No zero on a logarithmic axis, and four digits are more than a screen shows.
    let points = spectrum.frequency_hz.iter().zip(&spectrum.density).filter(|(f, d)| **f > 0.0 && **d > 0.0);
    let (x, y) = points.map(|(f, d)| (four_digits(*f), four_digits(*d))).unzip();
    Scatter::new(x, y)
        .mode(Mode::Lines)
        .name(&curve.name)
        .hover_template("%{y} nT/√Hz")
        .line(Line::new().color(curve.colour).width(2.0).dash(curve.dash.clone()))
}

fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Range of the axis, in decades.
pub(super) fn range<'a>(spectra: impl Iterator<Item = &'a AmplitudeSpectrum>) -> Option<(f64, f64)> {
    let positive = spectra.flat_map(|spectrum| spectrum.density.iter().skip(1)).copied().filter(|d| *d > 0.0);
    let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)));
    let top = high.log10() + 0.1;
    // At least a decade, or the scatter of a flat spectrum fills the chart.
    (high > 0.0).then(|| ((low.log10() - 0.1).max(top - DECADES).min(top - 1.0), top))
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
