//! The 18 coefficients with their confidence, one chart per unit.

use std::ops::Range;

use plotly::common::{ErrorData, ErrorType, Marker, Mode};
use plotly::layout::HoverMode;
use plotly::{Plot, Scatter};
use serde_json::json;
use towmag::model::{TERM_NAMES, TERM_UNITS, TERMS};

use super::base::{Chart, axis, layout, plain};
use super::palette::Look;
use crate::run::{Coefficient, MethodResult};
use crate::text::number::three_digits;

/// Terms that share a unit, and what they are called.
const GROUPS: [(&str, &str, Range<usize>); 3] =
    [("permanent", "Permanent, nT", 0..3), ("induced", "Induced, nT per nT", 3..9), ("eddy", "Eddy current, s", 9..18)];

/// The charts; none when no method has coefficients.
pub(in crate::report) fn coefficients(methods: &[MethodResult], looks: &[Look]) -> Vec<Chart> {
    if methods.iter().all(|method| method.coefficients.is_none()) {
        return Vec::new();
    }
    GROUPS.into_iter().map(|(id, title, terms)| chart(id, title, terms, methods, looks)).collect()
}

fn chart(id: &str, title: &str, terms: Range<usize>, methods: &[MethodResult], looks: &[Look]) -> Chart {
    let mut plot = Plot::new();
    for (method, look) in methods.iter().zip(looks) {
        if let Some(values) = &method.coefficients {
            plot.add_trace(trace(&method.name, values, terms.clone(), look));
        }
    }
    plot.set_layout(layout().hover_mode(HoverMode::Closest).x_axis(axis("")).y_axis(axis(title)));
    // Beside one another, not on top: that is what `scattermode` is for.
    let also = json!({
        "scattermode": "group",
        "scattergap": 0.4,
        "showlegend": methods.len() > 1,
        "xaxis": {"type": "category", "title": {"text": ""}},
        "yaxis": {"exponentformat": "power"},
    });
    Chart::new(&format!("coefficients-{id}"), &format!("Coefficients: {title}"), 340, plot, also)
}

fn trace(name: &str, values: &[Coefficient; TERMS], terms: Range<usize>, look: &Look) -> Box<Scatter<String, f64>> {
    let part = &values[terms.clone()];
    let twice: Vec<f64> = part.iter().map(|c| if c.std.is_finite() { 2.0 * c.std } else { 0.0 }).collect();
    let bars = ErrorData::new(ErrorType::Data).array(twice).color(look.colour).thickness(1.5).width(4);
    let text = terms.clone().zip(part).map(|(i, c)| hover(i, c)).collect();
    let x = terms.map(|i| TERM_NAMES[i].split_once(' ').map_or(TERM_NAMES[i], |(_, axes)| axes).to_owned());
    Scatter::new(x.collect(), part.iter().map(|c| c.value).collect())
        .mode(Mode::Markers)
        .name(plain(name))
        .marker(Marker::new().color(look.colour).size(7))
        .error_y(bars)
        .hover_text_array(text)
        .hover_template("%{hovertext}")
}

fn hover(term: usize, coefficient: &Coefficient) -> String {
    let [value, two_std] = [coefficient.value, 2.0 * coefficient.std].map(three_digits);
    format!("{}: {value} ± {two_std} {}", TERM_NAMES[term], TERM_UNITS[term])
}
