//! Residual by heading: one set of coefficients may suit one heading and not another.

use plotly::common::{Marker, Visible};
use plotly::layout::BarMode;
use plotly::{Bar, Plot};
use serde_json::json;

use super::base::{BEFORE_NAME, Chart, axis, drawn, layout, plain};
use super::palette::{BEFORE, Look};
use super::time::dwarfs;
use crate::collect::{HeadingStd, SECTORS};
use crate::report::data::ReportData;
use crate::text::number::{group, three_digits};

/// The chart of `data`, in the given looks; `None` when no heading is known.
pub(in crate::report) fn heading(data: &ReportData, looks: &[Look]) -> Option<Chart> {
    let known = |headings: &HeadingStd| headings.iter().any(|sector| sector.count > 0);
    if !known(&data.uncompensated.headings) && !data.methods.iter().any(|method| known(&method.headings)) {
        return None;
    }
    let mut plot = Plot::new();
    let visible = if dwarfs(data) { Visible::LegendOnly } else { Visible::True };
    plot.add_trace(trace(&data.uncompensated.headings, BEFORE_NAME, BEFORE).visible(visible));
    for (method, look) in drawn(data, looks) {
        plot.add_trace(trace(&method.headings, &plain(&method.name), look.colour));
    }
    let layout = layout().bar_mode(BarMode::Group).x_axis(axis("heading")).y_axis(axis("STD of the residual, nT"));
    plot.set_layout(layout);
    Some(Chart::new("by-heading", "Residual by heading", 360, plot, json!({})))
}

fn trace(headings: &HeadingStd, name: &str, colour: &'static str) -> Box<Bar<&'static str, Option<f64>>> {
    let known = headings.iter().map(|sector| (sector.count > 0).then_some(sector.std_nt)).collect();
    let text = headings
        .iter()
        .map(|sector| format!("{} nT, {} rows", three_digits(sector.std_nt), group(sector.count as i64)));
    Bar::new(SECTORS.to_vec(), known)
        .name(name)
        .marker(Marker::new().color(colour))
        .hover_text_array(text.collect())
        .hover_template("%{hovertext}")
}
