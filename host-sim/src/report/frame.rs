//! What every page has: the title, the answer, what to know before trusting it, the facts, the scripts.

use std::borrow::Cow;

use plotly::Plot;

/// Fills `frame.html`, which the pages extend.
pub(super) struct PageFrame<'a> {
    /// Title of the page.
    pub(super) title: &'a str,
    /// What was done to the recording.
    pub(super) kind: &'static str,
    /// File name of the recording.
    pub(super) recording: &'a str,
    /// The answer in a sentence.
    pub(super) headline: Cow<'a, str>,
    /// Its class in the style sheet, for one that is long; empty for the others.
    pub(super) headline_class: &'static str,
    /// Shown beneath it.
    pub(super) warnings: &'a [String],
    /// Label and value, shown last.
    pub(super) facts: &'a [(String, String)],
    /// The chart library; empty on a page that draws its own charts.
    pub(super) plotly_js: String,
}

/// The chart library alone. The crate hands it out together with a formula typesetter of 2 MB that no chart here needs.
pub(super) fn plotly_js() -> String {
    let sources = Plot::offline_js_sources();
    let scripts = sources.split("<script").filter_map(|tag| tag.split_once('>')?.1.split_once("</script>"));
    let plotly = scripts.map(|(script, _)| script).find(|script| script.trim_start().starts_with("/**\n* plotly.js v"));
    plotly.unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chart_library_is_taken_whole_and_alone() {
        let script = plotly_js();
        assert!(script.len() > 3_000_000 && script.len() < 5_000_000, "{}", script.len());
        assert!(script.contains("Plotly") && !script.contains("</script"));
    }
}
