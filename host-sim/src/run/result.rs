//! What a pass makes of a recording: plain data, for the summary, the tables and the page. Figures in nT, times in seconds
//! of the recording.

use towmag::model::TERMS;

use super::adaptation::AdaptationSummary;
use crate::collect::{AmplitudeSpectrum, Envelope, FigureOfMerit, HeadingStd, RunningStd};

/// The recording before compensation.
#[derive(Clone, Debug)]
pub struct Uncompensated {
    /// Scalar reading, nT.
    pub scalar_nt: Envelope,
    /// Band-passed scalar reading, nT.
    pub band_passed_nt: Envelope,
    /// Population standard deviation of the band-passed scalar reading, nT.
    pub std_nt: f64,
    /// Normalised fourth difference of the scalar reading, nT; `None` where no five rows follow one another.
    pub fourth_difference_nt: Option<f64>,
    /// Spectrum of the band-passed scalar reading.
    pub spectrum: AmplitudeSpectrum,
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
    pub spectrum: AmplitudeSpectrum,
    /// Standard deviation of the residual by heading.
    pub headings: HeadingStd,
    /// Coefficients at the end, in the units of eq. (4); `None` for a method without.
    pub coefficients: Option<[Coefficient; TERMS]>,
    /// What the method said of itself, if it does.
    pub adaptation: Option<AdaptationSummary>,
    /// The same figures from the third minute on; `None` in a recording that is shorter.
    pub settled: Option<Settled>,
    /// Median of the residual's standard deviation in windows of 10 s, nT; `None` in a recording that is shorter.
    pub noise_floor_nt: Option<f64>,
    /// Normalised fourth difference of the compensated reading, nT.
    pub fourth_difference_nt: Option<f64>,
    /// Standard deviation of the band-passed scalar by heading, over the rows of `headings`.
    pub headings_before: HeadingStd,
    /// Peak to peak by manoeuvre and heading, where manoeuvres can be told.
    pub merit: FigureOfMerit,
}

impl MethodResult {
    /// Standard deviation before over after: the IR of the paper.
    pub fn improvement_ratio(&self) -> f64 {
        self.std_before_nt / self.std_after_nt
    }
}

/// Figures of the rows after settling: [`SETTLED_S`](super::SETTLED_S) after the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// How many they are.
    pub rows: u64,
    /// Standard deviation of the band-passed scalar, nT.
    pub std_before_nt: f64,
    /// That of the residual, nT.
    pub std_after_nt: f64,
}

impl Settled {
    /// Of what was collected before and after compensation.
    pub(super) fn of([before, after]: [RunningStd; 2]) -> Option<Self> {
        let rows = after.count();
        (rows > 0).then(|| Self { rows, std_before_nt: before.std(), std_after_nt: after.std() })
    }

    /// The one over the other.
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
