//! What a trial came to: shares by strength, and probabilities against what came.

use plotly::common::{ErrorData, ErrorType, Line, Marker, Mode};
use plotly::layout::BarMode;
use plotly::{Bar, Plot, Scatter};
use serde_json::json;
use towmag_trial::{Promise, Rate};

use super::{BEFORE, Chart, FLUXGATE, SCALAR, axis, layout};
use crate::text::number::rounded;

/// Colour of what is right or in the stated set.
pub(in crate::report) const IN_SET: &str = SCALAR;
/// Colour of what is named alone.
pub(in crate::report) const NAMED: &str = FLUXGATE;

/// Shares of one kind.
pub(in crate::report) struct Series {
    /// What they are called.
    pub(in crate::report) name: &'static str,
    /// Of their bars.
    pub(in crate::report) colour: &'static str,
    /// Strength and share.
    pub(in crate::report) rates: Vec<(f64, Rate)>,
}

/// Bars over strengths, each series with its colour; a share that was not counted has no bar.
pub(in crate::report) fn strengths(series: &[Series]) -> Chart {
    let mut plot = Plot::new();
    for Series { name, colour, rates } in series {
        let counted: Vec<&(f64, Rate)> = rates.iter().filter(|(_, rate)| rate.of > 0).collect();
        let shares: Vec<f64> = counted.iter().map(|(_, rate)| 100.0 * rate.share().unwrap_or(0.0)).collect();
        let side = |end: usize| {
            counted.iter().zip(&shares).map(move |((_, rate), share)| (100.0 * rate.ci95[end] - share).abs())
        };
        let bars = Bar::new(
            counted.iter().map(|(strength, _)| format!("strength {strength}")).collect(),
            shares.iter().map(|share| rounded(*share, 2)).collect(),
        )
        .name(*name)
        .marker(Marker::new().color(*colour))
        .error_y(errors(side(1).collect(), side(0).collect()))
        .hover_text_array(counted.iter().map(|(_, rate)| counted_text(name, rate)).collect())
        .hover_template("%{hovertext}<extra></extra>");
        plot.add_trace(bars);
    }
    plot.set_layout(layout().bar_mode(BarMode::Group).x_axis(axis("")).y_axis(axis("share, %")));
    let also = json!({"yaxis": {"range": [0, 102]}, "bargap": 0.35, "xaxis": {"type": "category"}});
    Chart::picture("strengths", "Share found by strength", 320, plot, also)
}

/// What was promised against what came.
pub(in crate::report) fn reliability(bins: &[Promise]) -> Chart {
    let promised: Vec<f64> = bins.iter().map(|bin| rounded(100.0 * bin.promised, 2)).collect();
    let came: Vec<f64> = bins.iter().map(|bin| rounded(100.0 * bin.came.share().unwrap_or(0.0), 2)).collect();
    let side =
        |end: usize| bins.iter().zip(&came).map(|(bin, came)| (100.0 * bin.came.ci95[end] - came).abs()).collect();
    let (up, down) = (side(1), side(0));
    let mut plot = Plot::new();
    let line = Scatter::new(vec![0.0, 100.0], vec![0.0, 100.0])
        .mode(Mode::Lines)
        .line(Line::new().color(BEFORE).width(1.0))
        .hover_template("as promised<extra></extra>");
    plot.add_trace(line);
    let points = Scatter::new(promised, came)
        .mode(Mode::Markers)
        .marker(Marker::new().color(SCALAR).size(9))
        .error_y(errors(up, down))
        .hover_text_array(bins.iter().map(|bin| counted_text("right", &bin.came)).collect())
        .hover_template("promised %{x} %: %{hovertext}<extra></extra>");
    plot.add_trace(points);
    plot.set_layout(layout().x_axis(axis("promised, %")).y_axis(axis("came true, %")));
    let range = json!({"range": [0, 102]});
    Chart::picture("reliability", "Probabilities against what came", 320, plot, json!({"xaxis": range, "yaxis": range}))
}

fn errors(up: Vec<f64>, down: Vec<f64>) -> ErrorData {
    ErrorData::new(ErrorType::Data).symmetric(false).array(up).array_minus(down).color("#444444").thickness(1.5)
}

/// "named alone: 18 of 20, 70 to 97 %".
fn counted_text(name: &str, rate: &Rate) -> String {
    let [low, high] = rate.ci95.map(|end| 100.0 * end);
    format!("{name}: {} of {}, {low:.0} to {high:.0} %", rate.hits, rate.of)
}
