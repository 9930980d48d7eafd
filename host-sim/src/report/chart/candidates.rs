//! What may be the main cause, most probable first.

use plotly::common::{Marker, Orientation, TextPosition};
use plotly::layout::HoverMode;
use plotly::{Bar, Plot};
use serde_json::json;

use super::{BEFORE, Chart, SCALAR, axis, layout};
use crate::diagnosis::{CandidateShare, Diagnosis};
use crate::text::diagnosis::{label, percent};
use crate::text::number::rounded;
use crate::text::wrap::wrapped;

/// Effects that are shown at most, `none` and `unknown` apart.
const MOST: usize = 10;
/// Effects that are shown however improbable they are.
const FEWEST: usize = 3;
/// Probability below which an effect is one of those.
const LEAST: f64 = 0.01;
/// Effects that are not among those named.
const NOT_NAMED: &str = "#9DC3DE";
/// Longest line of a label, characters.
const LINE: usize = 22;

/// The chart; `None` when there are no candidates.
pub(in crate::report) fn candidates(diagnosis: &Diagnosis) -> Option<Chart> {
    let shown = shown(&diagnosis.candidates);
    if shown.is_empty() {
        return None;
    }
    let names: Vec<String> = shown.iter().map(|candidate| in_lines(&label(&diagnosis.specs, candidate.name))).collect();
    let shares: Vec<f64> = shown.iter().map(|candidate| rounded(100.0 * candidate.probability, 2)).collect();
    let colours: Vec<&str> = shown.iter().map(|candidate| colour(diagnosis, candidate)).collect();
    let mut plot = Plot::new();
    let bars = Bar::new(shares, names)
        .orientation(Orientation::Horizontal)
        .marker(Marker::new().color_array(colours))
        .text_array(shown.iter().map(|candidate| percent(candidate.probability)).collect())
        .text_position(TextPosition::Outside)
        .clip_on_axis(false)
        .hover_text_array(shown.iter().map(|candidate| candidate.name).collect())
        .hover_template("%{hovertext}: %{text}<extra></extra>");
    plot.add_trace(bars);
    plot.set_layout(layout().hover_mode(HoverMode::Closest).x_axis(axis("as the main cause, %")).y_axis(axis("")));
    let also = json!({
        "xaxis": {"range": [0, 135], "tickvals": [0, 25, 50, 75, 100]},
        "yaxis": {"autorange": "reversed", "title": {"text": ""}, "ticks": ""},
        "bargap": 0.25,
    });
    Some(Chart::picture("candidates", "Probability of each candidate", 70 + 36 * shown.len(), plot, also))
}

/// How many candidates are not shown.
pub(in crate::report) fn others(all: &[CandidateShare]) -> usize {
    all.len() - shown(all).len()
}

/// The most probable effects, and in any case `none` and `unknown`, which come last where they are not more probable.
fn shown(all: &[CandidateShare]) -> Vec<&CandidateShare> {
    let is_effect = |candidate: &CandidateShare| !matches!(candidate.name, "none" | "unknown");
    let mut effects = 0;
    let mut shown: Vec<&CandidateShare> = Vec::new();
    for candidate in all {
        effects += usize::from(is_effect(candidate));
        if !is_effect(candidate) || effects <= FEWEST || (effects <= MOST && candidate.probability >= LEAST) {
            shown.push(candidate);
        }
    }
    shown.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    shown
}

fn colour(diagnosis: &Diagnosis, candidate: &CandidateShare) -> &'static str {
    match candidate.name {
        "none" | "unknown" => BEFORE,
        name if diagnosis.effects.iter().any(|effect| effect.name == name) => SCALAR,
        _ => NOT_NAMED,
    }
}

/// In lines that leave room for the bars on a phone.
fn in_lines(label: &str) -> String {
    wrapped(label, LINE).join("<br>")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Library;

    fn share(name: &'static str, probability: f64) -> CandidateShare {
        CandidateShare { name, probability, identifiable_fraction: None }
    }

    #[test]
    fn none_and_unknown_are_always_shown() {
        let mut all = vec![share("scalar_lag", 0.9)];
        all.extend((0..20).map(|_| share("dead_zone", 0.02)));
        all.extend([share("unknown", 0.05), share("none", 0.0)]);
        let names: Vec<&str> = shown(&all).iter().map(|candidate| candidate.name).collect();
        assert_eq!(names.len(), MOST + 2);
        assert_eq!((names[1], names[MOST + 1]), ("unknown", "none"));
        all.iter_mut().skip(1).for_each(|candidate| candidate.probability *= 0.1);
        assert_eq!((shown(&all).len(), others(&all)), (FEWEST + 2, 18));
    }

    #[test]
    fn labels_are_short_lines() {
        assert_eq!(
            in_lines(&label(&Library::default().specs().collect::<Vec<_>>(), "scalar_lag")),
            "Delay of the scalar<br>reading"
        );
    }
}
