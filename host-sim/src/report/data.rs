//! What a report is made from: plain data, without a word of HTML. Figures in nT, times in seconds of the recording.

use crate::detection::Combination;
use crate::run::{MethodResult, Uncompensated};
use crate::text::number::three_digits;

/// Which command the report is of. It decides what may be claimed of the figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The coefficients were fitted to this very recording.
    Calibrate,
    /// One method ran through the recording.
    Replay,
    /// Several methods ran through the same recording.
    Compare,
}

/// Everything on the page.
#[derive(Clone, Debug)]
pub struct ReportData {
    /// Title of the page.
    pub title: String,
    /// Which command it is of.
    pub kind: Kind,
    /// File name of the recording.
    pub recording: String,
    /// Label and value: duration, rows, used rows, gaps, settings, version. Shown last, in this order.
    pub facts: Vec<(String, String)>,
    /// What the reader must know before trusting the figures. Shown beneath the answer.
    pub warnings: Vec<String>,
    /// The answer in one sentence; see [`headline`].
    pub headline: String,
    /// Corners of the band-pass, Hz.
    pub band_hz: [f64; 2],
    /// The recording before compensation.
    pub uncompensated: Uncompensated,
    /// What each method made of it, in the order to be shown.
    pub methods: Vec<MethodResult>,
    /// What each method does to injected anomalies; empty without any.
    pub detection: Vec<Combination>,
}

/// The method that leaves the least, if any leaves a finite amount.
pub fn best(methods: &[MethodResult]) -> Option<usize> {
    let finite = methods.iter().enumerate().filter(|(_, method)| method.std_after_nt.is_finite());
    finite.min_by(|(_, a), (_, b)| a.std_after_nt.total_cmp(&b.std_after_nt)).map(|(index, _)| index)
}

/// The answer in one sentence: what the best method leaves of what there was.
pub fn headline(methods: &[MethodResult]) -> String {
    let Some(method) = best(methods).map(|index| &methods[index]) else {
        return "No method gave a result.".into();
    };
    let ratio = method.improvement_ratio();
    let times = match ratio {
        r if r >= 1.005 => format!("{} times quieter", three_digits(r)),
        r if r > 0.995 => "no change".into(),
        r => format!("{} times louder", three_digits(1.0 / r)),
    };
    let [after, before] = [method.std_after_nt, method.std_before_nt].map(three_digits);
    format!("{} leaves {after} nT of {before} nT: {times}.", method.name)
}
