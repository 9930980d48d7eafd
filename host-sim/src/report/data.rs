//! What a report is made from: plain data, without a word of HTML. Figures in nT, times in seconds of the recording.

use towmag::model::TERMS;

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
    pub detection: Vec<crate::detection::Combination>,
}

/// The recording before compensation.
#[derive(Clone, Debug)]
pub struct Uncompensated {
    /// Scalar reading, nT.
    pub scalar_nt: Envelope,
    /// Band-passed scalar reading, nT.
    pub band_passed_nt: Envelope,
    /// Population standard deviation of the band-passed scalar reading, nT.
    pub std_nt: f64,
    /// Spectrum of the band-passed scalar reading.
    pub spectrum: Spectrum,
    /// Standard deviation of the band-passed scalar reading by heading.
    pub headings: HeadingStd,
}

/// What one method made of the recording.
#[derive(Clone, Debug)]
pub struct MethodResult {
    /// Name, as on the command line.
    pub name: String,
    /// Standard deviation of the band-passed scalar over the rows that count, nT.
    pub std_before_nt: f64,
    /// Standard deviation of the band-passed residual over the same rows, nT. Strictly predictive, save in a
    /// calibration, where it is that of the fit.
    pub std_after_nt: f64,
    /// The same after each epoch's own update, nT; `None` where there is no update.
    pub std_after_update_nt: Option<f64>,
    /// Scalar reading less the interference, nT.
    pub compensated_nt: Envelope,
    /// Band-passed residual, nT.
    pub residual_nt: Envelope,
    /// Spectrum of the residual.
    pub spectrum: Spectrum,
    /// Standard deviation of the residual by heading.
    pub headings: HeadingStd,
    /// Coefficients at the end, in the units of eq. (4); `None` for a method without.
    pub coefficients: Option<[Coefficient; TERMS]>,
    /// What the method said of itself, if it does.
    pub adaptation: Option<crate::summary::AdaptationSummary>,
}

impl MethodResult {
    /// Standard deviation before over after: the IR of the paper.
    pub fn improvement_ratio(&self) -> f64 {
        self.std_before_nt / self.std_after_nt
    }
}

/// One coefficient and what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// Value, in the unit of its term.
    pub value: f64,
    /// Standard deviation in the same unit; NaN when it is not known.
    pub std: f64,
}

/// A long channel, reduced to what a screen can show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Envelope {
    /// Width of a bin, s.
    pub bin_width_s: f64,
    /// Bins in order of time; none is empty.
    pub bins: Vec<Bin>,
}

/// All samples of a short stretch of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Time of the first sample.
    pub time_s: f64,
    /// Smallest sample.
    pub min: f64,
    /// When it was taken.
    pub min_at_s: f64,
    /// Largest sample.
    pub max: f64,
    /// When it was taken.
    pub max_at_s: f64,
    /// Mean of the samples.
    pub mean: f64,
    /// Number of samples, at least one.
    pub count: u64,
    /// There is a gap just before it: the line is broken.
    pub after_gap: bool,
}

impl Envelope {
    /// Mean of all samples; `None` when there are none.
    pub fn mean(&self) -> Option<f64> {
        let count: u64 = self.bins.iter().map(|bin| bin.count).sum();
        let sum: f64 = self.bins.iter().map(|bin| bin.mean * bin.count as f64).sum();
        (count > 0).then(|| sum / count as f64)
    }

    /// Smallest and largest sample; `None` when there are none.
    pub fn range(&self) -> Option<(f64, f64)> {
        let wider = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        self.bins.iter().map(|bin| (bin.min, bin.max)).reduce(wider)
    }
}

/// Amplitude spectral density. Empty when no stretch without a gap was long enough.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Frequencies, Hz, from zero to half the sample rate.
    pub frequency_hz: Vec<f64>,
    /// Amplitude density at each, nT per square root of Hz.
    pub density: Vec<f64>,
}

/// The eight sectors of the compass.
pub const SECTORS: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];

/// Standard deviation in each sector, in the order of [`SECTORS`].
pub type HeadingStd = [SectorStd; 8];

/// Standard deviation of the samples taken on the headings of one sector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectorStd {
    /// Population standard deviation, nT; not meaningful when `count` is zero.
    pub std_nt: f64,
    /// Number of samples.
    pub count: u64,
}

/// The method that leaves the least, if any leaves a finite amount.
pub fn best(methods: &[MethodResult]) -> Option<usize> {
    let finite = methods.iter().enumerate().filter(|(_, method)| method.std_after_nt.is_finite());
    finite.min_by(|(_, a), (_, b)| a.std_after_nt.total_cmp(&b.std_after_nt)).map(|(index, _)| index)
}

/// The answer in one sentence: what the best method leaves of what there was.
pub fn headline(methods: &[MethodResult]) -> String {
    use super::number::three_digits;
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
