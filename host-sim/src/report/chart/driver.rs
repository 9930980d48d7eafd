//! What has no name, over what drives it.

use plotly::common::{ColorBar, ColorScale, ColorScalePalette, DashType, Fill, Line, Mode};
use plotly::layout::HoverMode;
use plotly::{HeatMap, Plot, Scatter};
use serde_json::json;

use super::base::{Chart, axis, layout, plain};
use super::palette::SCALAR;
use crate::diagnosis::{Curve, CurvePoint, Map};
use crate::text::number::{rounded, short};

/// Of the 95 % band.
const BAND: &str = "rgba(31,119,180,0.18)";
const FITTED: &str = "#222222";

/// The mean of what is left with its band, and what is fitted, where that is more than nothing.
pub(in crate::report) fn driver(curve: &Curve) -> Chart {
    let line = |of: fn(&CurvePoint) -> f64| {
        let (x, y) = curve.points.iter().map(|point| (digits(point.driver, 4), rounded(of(point), 5))).unzip();
        Scatter::<f64, f64>::new(x, y).mode(Mode::Lines)
    };
    let edge = || Line::new().width(0.0);
    let mut plot = Plot::new();
    plot.add_trace(
        line(|point| point.band_nt[0]).line(edge()).show_legend(false).hover_info(plotly::common::HoverInfo::Skip),
    );
    plot.add_trace(line(|point| point.band_nt[1]).line(edge()).fill(Fill::ToNextY).fill_color(BAND).name("95 % band"));
    plot.add_trace(line(|point| point.left_nt).name("left over").line(Line::new().color(SCALAR).width(2.0)));
    if curve.points.iter().any(|point| point.fitted_nt.abs() > 1e-9) {
        let fitted = line(|point| point.fitted_nt).name("fitted");
        plot.add_trace(fitted.line(Line::new().color(FITTED).width(1.5).dash(DashType::Dash)));
    }
    plot.set_layout(layout().x_axis(axis(&plain(&curve.over))).y_axis(axis("left over, nT")));
    Chart::new("driver", "What is left over what drives it", 360, plot, json!({}))
}

/// The same over two: cells that are blue or red as far as they are from nothing, with their bands where one points.
pub(in crate::report) fn driver_map(map: &Map) -> Chart {
    let each = |cell: &Option<CurvePoint>| cell.map(|cell| rounded(cell.left_nt, 4));
    let cells: Vec<Vec<Option<f64>>> = map.cells.iter().map(|line| line.iter().map(each).collect()).collect();
    let most = cells.iter().flatten().flatten().fold(0.0, |most: f64, nt| most.max(nt.abs()));
    // Parts with equally many rows are equally large: most of a driver's range is often crossed in few of them.
    let places = |k: usize| (0..map.edges[k].len()).collect::<Vec<usize>>();
    let ticks = |k: usize| {
        let names: Vec<String> =
            map.edges[k].iter().map(|edge| digits(*edge, 2).to_string().replace('-', "−")).collect();
        json!({"tickvals": places(k), "ticktext": names, "showgrid": false, "zeroline": false})
    };
    let heat = HeatMap::new(places(0), places(1), cells)
        .color_scale(ColorScale::Palette(ColorScalePalette::RdBu))
        .zmin(-most)
        .zmax(most)
        .color_bar(ColorBar::new().title("nT").thickness(12))
        .hover_on_gaps(false)
        .hover_text_matrix(map.cells.iter().map(|line| line.iter().map(told).collect()).collect())
        .hover_template("%{hovertext}<extra></extra>");
    let mut plot = Plot::new();
    plot.add_trace(heat);
    plot.set_layout(
        layout().hover_mode(HoverMode::Closest).x_axis(axis(&plain(&map.over[0]))).y_axis(axis(&plain(&map.over[1]))),
    );
    Chart::new(
        "driver-map",
        "What is left over what drives it and one thing beside",
        420,
        plot,
        json!({"xaxis": ticks(0), "yaxis": ticks(1)}),
    )
}

/// A cell in words.
fn told(cell: &Option<CurvePoint>) -> String {
    let Some(CurvePoint { left_nt, band_nt: [low, high], .. }) = cell else { return String::new() };
    format!("{} nT, 95 % band {} to {}", short(*left_nt), short(*low), short(*high))
}

/// No more significant digits than are shown.
fn digits(value: f64, count: usize) -> f64 {
    format!("{value:.*e}", count - 1).parse().unwrap_or(value)
}
