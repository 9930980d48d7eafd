//! What has no name, over what drives it.

use plotly::common::{DashType, Fill, Line, Mode};
use plotly::{Plot, Scatter};
use serde_json::json;

use super::base::{Chart, axis, layout, plain};
use super::palette::SCALAR;
use crate::diagnosis::{CurvePoint, Shape};
use crate::text::number::rounded;

/// Of the 95 % band.
const BAND: &str = "rgba(31,119,180,0.18)";
const FITTED: &str = "#222222";

/// The mean of what is left with its band, and what is fitted, where that is more than nothing.
pub(in crate::report) fn driver(shape: &Shape) -> Chart {
    let line = |of: fn(&CurvePoint) -> f64| {
        let (x, y) = shape.points.iter().map(|point| (digits(point.driver), rounded(of(point), 5))).unzip();
        Scatter::<f64, f64>::new(x, y).mode(Mode::Lines)
    };
    let edge = || Line::new().width(0.0);
    let mut plot = Plot::new();
    plot.add_trace(
        line(|point| point.band_nt[0]).line(edge()).show_legend(false).hover_info(plotly::common::HoverInfo::Skip),
    );
    plot.add_trace(line(|point| point.band_nt[1]).line(edge()).fill(Fill::ToNextY).fill_color(BAND).name("95 % band"));
    plot.add_trace(line(|point| point.left_nt).name("left over").line(Line::new().color(SCALAR).width(2.0)));
    if shape.points.iter().any(|point| point.fitted_nt.abs() > 1e-9) {
        let fitted = line(|point| point.fitted_nt).name("fitted");
        plot.add_trace(fitted.line(Line::new().color(FITTED).width(1.5).dash(DashType::Dash)));
    }
    plot.set_layout(layout().x_axis(axis(&plain(&shape.over))).y_axis(axis("left over, nT")));
    Chart::new("driver", "What is left over what drives it", 360, plot, json!({}))
}

/// More than four digits no screen shows.
fn digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
