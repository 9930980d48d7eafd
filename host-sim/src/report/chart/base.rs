//! What all charts share: their frame as JSON for plotly.js, axes and layout.

use plotly::common::{Anchor, Font, Orientation, Title};
use plotly::configuration::{DisplayModeBar, ModeBarButtonName};
use plotly::layout::{Axis, HoverMode, Legend, Margin};
use plotly::{Configuration, Layout, Plot};
use serde_json::{Value, json};

use super::palette::Look;
use crate::report::data::ReportData;
use crate::run::MethodResult;

/// Before compensation, in every legend.
pub(super) const BEFORE_NAME: &str = "uncompensated";

const GRID: &str = "#E3E3E3";
const INK: &str = "#222222";

/// A chart ready for the page.
pub(in crate::report) struct Chart {
    /// Name of the element, and of the picture when it is saved.
    pub(in crate::report) id: String,
    /// What a screen reader says of it.
    pub(in crate::report) label: String,
    /// Height, pixels; the width is the page's.
    pub(in crate::report) height_px: usize,
    /// Data, layout and configuration, safe inside a script element.
    pub(in crate::report) json: String,
}

impl Chart {
    /// `also` is merged into the layout: what the typed interface has no names for.
    pub(super) fn new(id: &str, label: &str, height_px: usize, plot: Plot, also: Value) -> Self {
        Self::with(id, label, height_px, plot, also, configuration())
    }

    /// A small chart with nothing to zoom into: without buttons and without a legend, which stands beside it.
    pub(super) fn picture(id: &str, label: &str, height_px: usize, plot: Plot, mut also: Value) -> Self {
        let still = json!({
            "showlegend": false,
            "margin": {"t": 8, "r": 8},
            "dragmode": false,
            "xaxis": {"fixedrange": true},
            "yaxis": {"fixedrange": true},
        });
        merge(&mut also, still);
        Self::with(id, label, height_px, plot, also, configuration().display_mode_bar(DisplayModeBar::False))
    }

    fn with(
        id: &str,
        label: &str,
        height_px: usize,
        mut plot: Plot,
        also: Value,
        configuration: Configuration,
    ) -> Self {
        plot.set_configuration(configuration);
        let mut value = serde_json::from_str(&plot.to_json()).unwrap_or(Value::Null);
        merge(&mut value["layout"], json!({"legend": {"itemsizing": "constant", "traceorder": "normal"}}));
        merge(&mut value["layout"], also);
        value["config"]["toImageButtonOptions"] = json!({ "filename": id, "scale": 2 });
        // Inside a script element nothing ends the data but "<": "</script>" in a name must not.
        let json = value.to_string().replace('<', "\\u003c");
        Self { id: id.into(), label: label.into(), height_px, json }
    }
}

/// The methods that have lines of their own. One without coefficients is the uncompensated recording, drawn as such.
pub(super) fn drawn<'a>(data: &'a ReportData, looks: &'a [Look]) -> impl Iterator<Item = (&'a MethodResult, &'a Look)> {
    data.methods.iter().zip(looks).filter(|(method, _)| method.coefficients.is_some())
}

pub(super) fn merge(into: &mut Value, from: Value) {
    match (into, from) {
        (Value::Object(into), Value::Object(from)) => {
            for (key, value) in from {
                merge(into.entry(key).or_insert(Value::Null), value);
            }
        }
        (into, from) => *into = from,
    }
}

fn configuration() -> Configuration {
    use ModeBarButtonName::{AutoScale2d, Lasso2d, Select2d};
    Configuration::new()
        .responsive(true)
        .display_logo(false) // it links to a web site
        .display_mode_bar(DisplayModeBar::True)
        .mode_bar_buttons_to_remove(vec![AutoScale2d, Lasso2d, Select2d])
}

pub(super) fn layout() -> Layout {
    let font = Font::new().size(13).color(INK).family("system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif");
    let legend = Legend::new().orientation(Orientation::Horizontal).x(0.0).y(1.0).y_anchor(Anchor::Bottom);
    Layout::new()
        .font(font)
        .legend(legend)
        .show_legend(true)
        .margin(Margin::new().left(64).right(12).top(36).bottom(48))
        .hover_mode(HoverMode::XUnified)
        .paper_background_color("#FFFFFF")
        .plot_background_color("#FFFFFF")
}

pub(super) fn axis(title: &str) -> Axis {
    Axis::new()
        .title(Title::with_text(title))
        .grid_color(GRID)
        .zero_line_color("#9A9A9A")
        .line_color("#9A9A9A")
        .show_line(true)
        .auto_margin(true)
}

/// `text` as plotly.js will show it: it takes some of HTML in names for markup.
pub(super) fn plain(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotly::Scatter;

    #[test]
    fn names_cannot_leave_the_script_element() {
        let mut plot = Plot::new();
        plot.add_trace(Scatter::new(vec![0.0], vec![0.0]).name(plain("</script><b>&")));
        let chart = Chart::new("id", "label", 1, plot, json!({}));
        assert!(!chart.json.contains('<'));
        let back: Value = serde_json::from_str(&chart.json).unwrap();
        assert_eq!(back["data"][0]["name"], "&lt;/script&gt;&lt;b&gt;&amp;");
    }
}
