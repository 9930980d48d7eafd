//! `host-sim calibrate`: batch elastic net, eq. (7), of rows that are band-passed without delay.

use std::path::Path;

use towmag::estimate::{Calibration, CalibrationError, CalibrationResult};
use towmag::model::{NT_PER_UNIT, TERMS};
use towmag::{Epoch, Method, Settings, SettingsError};

use super::inputs::keep_inputs;
use super::report_data::{CalibrationFacts, report_data};
use super::start::start_at;
use super::zero_phase::ZeroPhase;
use crate::coefficients_file::{CoefficientsFile, Origin};
use crate::error::HostError;
use crate::output::OutputDir;
use crate::progress::Progress;
use crate::provenance::{InputBytes, Provenance, estimator_options};
use crate::recording::{Input, RecordingRow};
use crate::report::{Kind, render};
use crate::run::{Counts, MethodResult, pass};
use crate::summary::{Summary, to_json};

/// Valid rows that a calibration needs at least, as seconds.
const LEAST_VALID_S: f64 = 60.0;

const RESULTS: [&str; 3] = ["coefficients.toml", "report.html", "summary.json"];

/// A calibration and what it says of itself.
pub struct CalibrateResult {
    /// What `coefficients.toml` holds.
    pub file: CoefficientsFile,
    /// What `summary.json` holds.
    pub summary: Summary,
}

/// Calibrate from a recording and write coefficients, summary and report.
pub fn calibrate(recording: impl Into<Input>, out: &Path, settings: &Settings) -> Result<CalibrateResult, HostError> {
    let recording = recording.into();
    keep_inputs(recording.named().as_slice(), out, &RESULTS)?;
    let output = OutputDir::create(out)?;
    let recording = recording.ready()?;
    let fitted = fit(&recording, settings)?;
    let start = start_at(&fitted.file);
    // A second pass, for the pictures: the fit itself keeps no samples.
    let mut passed = pass(&mut *recording.open()?, &[Method::Fixed], settings, &start, |_| Ok(()))?;
    for method in &mut passed.methods {
        fitted.describe(method);
    }
    let summary = Summary {
        provenance: Some(Provenance::new(
            "calibrate",
            estimator_options(settings),
            vec![InputBytes::of_recording("recording", &recording)?],
        )),
        ..fitted.summary(&passed.methods[0])
    };
    let facts = CalibrationFacts::from(&fitted.file.calibration);
    let report = report_data(Kind::Calibrate, &recording.file_name(), passed, settings, Some(&facts));
    output.write("coefficients.toml", fitted.file.to_toml())?;
    output.write("report.html", render(&report)?)?;
    output.write("summary.json", to_json(&summary))?;
    output.commit("summary.json")?;
    Ok(CalibrateResult { file: fitted.file, summary })
}

/// A fit, before anything is written.
pub(super) struct Fitted {
    pub(super) file: CoefficientsFile,
    pub(super) counts: Counts,
    std_after_nt: f64,
}

/// Fit the coefficients to a recording.
pub(super) fn fit(input: &Input, settings: &Settings) -> Result<Fitted, HostError> {
    let mut recording = input.open()?;
    let progress = Progress::of(&*recording);
    let mut fits = Fits::new(settings)?;
    let (mut counts, mut valid_rows) = (Counts::default(), 0_u64);
    let mut row = RecordingRow::default();
    while recording.read_row(&mut row)? {
        counts.count(&row);
        progress.update(&*recording, counts.rows);
        valid_rows += u64::from(row.is_usable());
        if row.is_on_grid {
            fits.step(&row.epoch);
        }
    }
    counts.bad_rows = recording.bad_rows().cloned().unwrap_or_default();
    let valid_s = valid_rows as f64 / settings.band_pass.sample_rate_hz;
    if valid_s < LEAST_VALID_S {
        return Err(HostError::NotEnough(format!(
            "{}: {valid_s:.1} s of valid rows, a calibration needs at least {LEAST_VALID_S:.0} s",
            input.shown()
        )));
    }
    let (result, known) = fits.solve().map_err(|error| unusable(input, error))?;
    counts.used_rows = u64::from(result.used_epochs);
    let file = file_of(input, settings, &result).with_information_of(&known);
    Ok(Fitted { file, counts, std_after_nt: result.rms_after_nt })
}

/// A recording fitted without delay, for the coefficients, and as on the body, for what the adaptive method starts from:
/// on the flights it starts no better from all rows, see `docs/adaptive.md`.
struct Fits {
    zero_phase: ZeroPhase,
    whole: Calibration,
    causal: Calibration,
}

impl Fits {
    fn new(settings: &Settings) -> Result<Self, SettingsError> {
        let calibration = Calibration::new(settings)?;
        Ok(Self { zero_phase: ZeroPhase::new(settings.band_pass)?, whole: calibration.clone(), causal: calibration })
    }

    fn step(&mut self, epoch: &Epoch) {
        self.zero_phase.step(epoch, |row| self.whole.add(row));
        let _rejected_ones_are_counted_by_the_result = self.causal.step(epoch);
    }

    /// The one of all rows, and the one whose information counts. Between many gaps no filter settles; then they are one.
    fn solve(mut self) -> Result<(CalibrationResult, CalibrationResult), CalibrationError> {
        self.zero_phase.finish(|row| self.whole.add(row));
        let whole = self.whole.solve()?;
        let causal = self.causal.solve().unwrap_or_else(|_| whole.clone());
        Ok((whole, causal))
    }
}

fn unusable(input: &Input, error: CalibrationError) -> HostError {
    HostError::NotEnough(format!("{}: {error}", input.shown()))
}

fn file_of(input: &Input, settings: &Settings, result: &CalibrationResult) -> CoefficientsFile {
    let origin = Origin {
        recording: input.file_name(),
        used_rows: u64::from(result.used_epochs),
        std_before_nT: result.std_before_nt,
        std_after_nT: result.rms_after_nt,
        improvement_ratio: result.std_before_nt / result.rms_after_nt,
        condition_number: f64::from(result.condition_number),
        lambda1: settings.penalty.lambda1,
        lambda2: settings.penalty.lambda2,
        band_low_hz: settings.band_pass.low_hz,
        band_high_hz: settings.band_pass.high_hz,
    };
    let std: [f64; TERMS] = std::array::from_fn(|i| f64::from(result.std_nt[i]) / NT_PER_UNIT[i]);
    CoefficientsFile::new(origin, &result.coefficients.to_paper_units(), &std)
}

impl Fitted {
    /// The figures of the fit itself in place of those of the second pass, which counts the settling too.
    fn describe(&self, method: &mut MethodResult) {
        method.name = "calibration".into();
        method.std_before_nt = self.file.calibration.std_before_nT;
        method.std_after_nt = self.std_after_nt;
        method.settled = None; // the fit has no time in which it learns
    }

    fn summary(&self, method: &MethodResult) -> Summary {
        Summary {
            method: "elastic-net".into(),
            condition_number: Some(self.file.calibration.condition_number),
            ..Summary::new(method, &self.counts)
        }
    }
}
