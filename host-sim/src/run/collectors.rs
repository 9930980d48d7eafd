//! Collects what a pass shows, row by row. What is remembered does not grow with the recording.

use towmag::model::TERMS;

use super::result::{Coefficient, MethodResult, Settled, Uncompensated};
use crate::collect::{
    EnvelopeCollector, FourthDifference, HeadingSectors, MeritCollector, NoiseFloor, RunningStd, Welch,
};

/// From here on a method has settled, s after the first row: what it needs to learn a body that is not the calibrated one.
pub const SETTLED_S: f64 = 120.0;

/// One row of the recording, as every method sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub time_s: f64,
    /// Heading, if it is known.
    pub heading_deg: Option<f64>,
    /// Field in body axes, nT, if it is known.
    pub flux_nt: Option<[f64; 3]>,
    /// Scalar reading, nT.
    pub scalar_nt: f64,
    /// Band-passed scalar reading, nT; `None` while the band-pass settles, which keeps the row out of all figures.
    pub band_passed_nt: Option<f64>,
}

/// What a method made of a [`Row`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodRow {
    /// Scalar reading less the interference, nT.
    pub compensated_nt: f64,
    /// Band-passed residual, strictly predictive, nT.
    pub residual_nt: f64,
    /// The same after the row's own update, nT; `None` where there is no update.
    pub residual_after_update_nt: Option<f64>,
}

/// Standard deviation, picture, spectrum and headings of one band-passed channel.
#[derive(Clone)]
struct Band {
    std: RunningStd,
    envelope: EnvelopeCollector,
    spectrum: Welch,
    headings: HeadingSectors,
}

impl Band {
    fn new(sample_rate_hz: f64) -> Self {
        Self {
            std: RunningStd::default(),
            envelope: EnvelopeCollector::default(),
            spectrum: Welch::new(sample_rate_hz),
            headings: HeadingSectors::default(),
        }
    }

    fn push(&mut self, row: &Row, value_nt: f64) {
        self.std.push(value_nt);
        self.envelope.push(row.time_s, value_nt);
        self.spectrum.push(row.time_s, value_nt);
        if let Some(heading_deg) = row.heading_deg {
            self.headings.push(heading_deg, value_nt);
        }
    }
}

/// Collects the recording before compensation.
#[derive(Clone)]
pub struct RecordingCollector {
    scalar_nt: EnvelopeCollector,
    fourth_difference: FourthDifference,
    band_passed: Band,
}

impl RecordingCollector {
    /// Of a recording at `sample_rate_hz`.
    pub fn new(sample_rate_hz: f64) -> Self {
        Self {
            scalar_nt: EnvelopeCollector::default(),
            fourth_difference: FourthDifference::default(),
            band_passed: Band::new(sample_rate_hz),
        }
    }

    /// Take in one row that has a scalar reading; rows left out show as gaps.
    pub fn push(&mut self, row: &Row) {
        self.scalar_nt.push(row.time_s, row.scalar_nt);
        self.fourth_difference.push(row.time_s, row.scalar_nt);
        if let Some(band_passed_nt) = row.band_passed_nt {
            self.band_passed.push(row, band_passed_nt);
        }
    }

    /// What has been collected.
    pub fn finish(&self) -> Uncompensated {
        Uncompensated {
            scalar_nt: self.scalar_nt.envelope(),
            band_passed_nt: self.band_passed.envelope.envelope(),
            std_nt: self.band_passed.std.std(),
            fourth_difference_nt: self.fourth_difference.std(),
            spectrum: self.band_passed.spectrum.spectrum(),
            headings: self.band_passed.headings.std(),
        }
    }
}

/// Collects what one method makes of the recording.
#[derive(Clone)]
pub struct MethodCollector {
    compensated_nt: EnvelopeCollector,
    fourth_difference: FourthDifference,
    noise_floor: NoiseFloor,
    merit: MeritCollector,
    before: RunningStd,
    headings_before: HeadingSectors,
    /// When the rows begin that count as settled, s, and their figures before and after.
    settles_s: Option<f64>,
    settled: [RunningStd; 2],
    after_update: RunningStd,
    residual: Band,
}

impl MethodCollector {
    /// Of a recording at `sample_rate_hz`.
    pub fn new(sample_rate_hz: f64) -> Self {
        Self {
            compensated_nt: EnvelopeCollector::default(),
            fourth_difference: FourthDifference::default(),
            noise_floor: NoiseFloor::default(),
            merit: MeritCollector::default(),
            before: RunningStd::default(),
            headings_before: HeadingSectors::default(),
            settles_s: None,
            settled: [RunningStd::default(); 2],
            after_update: RunningStd::default(),
            residual: Band::new(sample_rate_hz),
        }
    }

    /// Take in one compensated row; rows left out show as gaps.
    pub fn push(&mut self, row: &Row, method: &MethodRow) {
        self.compensated_nt.push(row.time_s, method.compensated_nt);
        self.fourth_difference.push(row.time_s, method.compensated_nt);
        let settles_s = *self.settles_s.get_or_insert(row.time_s + SETTLED_S);
        let Some(band_passed_nt) = row.band_passed_nt else { return };
        self.before.push(band_passed_nt);
        self.residual.push(row, method.residual_nt);
        self.noise_floor.push(row.time_s, method.residual_nt);
        if let Some(heading_deg) = row.heading_deg {
            self.headings_before.push(heading_deg, band_passed_nt);
        }
        if let (Some(heading_deg), Some(flux_nt)) = (row.heading_deg, row.flux_nt) {
            self.merit.push(row.time_s, heading_deg, flux_nt, [band_passed_nt, method.residual_nt]);
        }
        if row.time_s >= settles_s {
            self.settled[0].push(band_passed_nt);
            self.settled[1].push(method.residual_nt);
        }
        if let Some(residual_nt) = method.residual_after_update_nt {
            self.after_update.push(residual_nt);
        }
    }

    /// What has been collected, under the method's name and with the coefficients that it ended on.
    pub fn finish(&self, name: &str, coefficients: Option<[Coefficient; TERMS]>) -> MethodResult {
        MethodResult {
            name: name.into(),
            std_before_nt: self.before.std(),
            std_after_nt: self.residual.std.std(),
            std_after_update_nt: (self.after_update.count() > 0).then(|| self.after_update.std()),
            compensated_nt: self.compensated_nt.envelope(),
            residual_nt: self.residual.envelope.envelope(),
            spectrum: self.residual.spectrum.spectrum(),
            headings: self.residual.headings.std(),
            coefficients,
            adaptation: None,
            settled: Settled::of(self.settled),
            noise_floor_nt: self.noise_floor.median(),
            fourth_difference_nt: self.fourth_difference.std(),
            headings_before: self.headings_before.std(),
            merit: self.merit.figure(),
        }
    }
}
