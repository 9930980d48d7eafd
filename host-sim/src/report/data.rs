//! What a report is made from: plain data, without a word of HTML. Figures in nT, times in seconds of the recording.

use crate::detection::{BandPulse, Combination};
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
    /// What each method does to injected anomalies, in detail; empty unless that was asked for.
    pub detection: Vec<Combination>,
    /// What each method keeps of anomalies in this recording, beside its residual; `None` where that was not tried.
    pub targets: Option<Combination>,
    /// What is marked on the compensated reading: contacts that were found, or what is known to be hidden.
    pub marks: Vec<Mark>,
    /// What the marks are.
    pub marks_note: Option<String>,
    /// What makes seconds since 1970 of the times, where that is known.
    pub utc_offset_s: Option<f64>,
    /// How the band shows a target, which is not how it is.
    pub pulse: Option<BandPulse>,
}

impl ReportData {
    /// The method to be shown as the best, if any gave a result.
    pub fn best(&self) -> Option<usize> {
        best(&self.methods, self.targets.as_ref())
    }
}

/// A place in time on a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where, s.
    pub time_s: f64,
    /// What is written there.
    pub label: String,
}

/// The best method: after which targets stand out most, where that is known, for what is quiet because it has fitted the
/// targets away is not good; else the one that leaves the least.
fn best(methods: &[MethodResult], targets: Option<&Combination>) -> Option<usize> {
    let stands_out = |method: &MethodResult| {
        let of = targets?.methods.iter().find(|of| of.method == method.name)?;
        of.detection.is_finite().then_some(of.detection)
    };
    let outstanding = methods.iter().enumerate().filter_map(|(index, method)| Some((index, stands_out(method)?)));
    let finite = methods.iter().enumerate().filter(|(_, method)| method.std_after_nt.is_finite());
    let quietest = || finite.min_by(|(_, a), (_, b)| a.std_after_nt.total_cmp(&b.std_after_nt)).map(|(index, _)| index);
    outstanding.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(index, _)| index).or_else(quietest)
}

/// The answer in one sentence: what the best method leaves of what there was, in the whole recording and after settling,
/// and of targets.
pub fn headline(methods: &[MethodResult], targets: Option<&Combination>) -> String {
    let Some(method) = best(methods, targets).map(|index| &methods[index]) else {
        return "No method gave a result.".into();
    };
    let [after, before] = [method.std_after_nt, method.std_before_nt].map(three_digits);
    let mut said = format!("{} leaves {after} nT of {before} nT: {}", method.name, times(method.improvement_ratio()));
    if let Some(settled) = &method.settled {
        let after = three_digits(settled.std_after_nt);
        said += &format!("; from the third minute on {after} nT, {}", times(settled.improvement_ratio()));
    }
    let kept = targets.and_then(|targets| targets.methods.iter().find(|of| of.method == method.name)).map(|of| of.kept);
    said += &kept.map_or(String::new(), |kept| format!("; {:.0}\u{a0}% of a target is kept", 100.0 * kept));
    said + "."
}

fn times(ratio: f64) -> String {
    match ratio {
        r if r >= 1.005 => format!("{} times quieter", three_digits(r)),
        r if r > 0.995 => "no change".into(),
        r => format!("{} times louder", three_digits(1.0 / r)),
    }
}
