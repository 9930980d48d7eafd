//! One method on its way through a recording.

use towmag::estimate::Quality;
use towmag::filter::BandPassDesign;
use towmag::model::{NT_PER_UNIT, TERMS};
use towmag::{Epoch, Method, Output, Pipeline, Rejection, Settings, SettingsError, Status};

use super::adaptation::AdaptationCounts;
use super::collectors::{MethodCollector, MethodRow, Row};
use super::result::{Coefficient, MethodResult};
use super::start::Start;

/// Name of a method on the command line and in every result.
pub fn method_name(method: Method) -> &'static str {
    match method {
        Method::None => "none",
        Method::Fixed => "fixed",
        Method::Rls => "rls",
        Method::SaddlePoint => "saddle-point",
        Method::Adaptive => "adaptive",
    }
}

/// The scalar reading less the interference, nT; to a millionth, which is finer than any sensor.
pub fn difference_nt(scalar_nt: f64, interference_nt: f64) -> f64 {
    ((scalar_nt - interference_nt) * 1e6).round() / 1e6
}

fn nothing_at(epoch: &Epoch) -> Output {
    Output { tick: epoch.tick, status: Status::Rejected(Rejection::ScalarMissing), compensated: None }
}

/// One method in motion.
pub(super) struct MethodRun {
    method: Method,
    pipeline: Pipeline,
    /// Outputs that were made elsewhere, if they were.
    given: Option<std::vec::IntoIter<Option<Output>>>,
    collector: MethodCollector,
    adaptation: AdaptationCounts,
}

impl MethodRun {
    pub(super) fn new(method: Method, settings: &Settings, start: &Start) -> Result<Self, SettingsError> {
        let settings = Settings { method, ..*settings };
        Ok(Self {
            method,
            pipeline: Pipeline::new(&settings, start.prior)?,
            given: None,
            collector: MethodCollector::new(settings.band_pass.sample_rate_hz),
            adaptation: AdaptationCounts::default(),
        })
    }

    /// The same with outputs that were made elsewhere, one for each row, and the core as it was after the last of them.
    pub(super) fn given(self, pipeline: Pipeline, outputs: Vec<Option<Output>>) -> Self {
        Self { pipeline, given: Some(outputs.into_iter()), ..self }
    }

    pub(super) fn step(&mut self, epoch: &Epoch) -> Output {
        let Some(given) = &mut self.given else { return self.pipeline.step(epoch) };
        given.next().flatten().unwrap_or(nothing_at(epoch))
    }

    /// A row that has no place on the grid: the core does not see it.
    pub(super) fn pass_over(&mut self, epoch: &Epoch) -> Output {
        let _output_of_the_row = self.given.as_mut().and_then(Iterator::next);
        nothing_at(epoch)
    }

    /// What the method says of its latest output. Outputs that were made elsewhere say nothing of themselves.
    pub(super) fn quality(&self) -> Option<&Quality> {
        if self.given.is_some() { None } else { self.pipeline.quality() }
    }

    pub(super) fn collect(&mut self, row: &Row, output: &Output) {
        if let Some(quality) = self.quality().copied() {
            self.adaptation.add(&quality);
        }
        let Some(compensated) = output.compensated else { return };
        let learns = self.pipeline.information().is_some();
        self.collector.push(
            row,
            &MethodRow {
                compensated_nt: difference_nt(row.scalar_nt, f64::from(compensated.interference_nt)),
                residual_nt: f64::from(compensated.residual_nt),
                residual_after_update_nt: learns.then_some(f64::from(compensated.residual_after_update_nt)),
            },
        );
    }

    pub(super) fn finish(&self, band_pass: BandPassDesign, start: &Start) -> MethodResult {
        let mut result = self.collector.finish(method_name(self.method), None);
        result.adaptation = self.adaptation.summary();
        let values = self.pipeline.coefficients().to_paper_units();
        let std = self.std(band_pass, start, result.std_after_nt);
        let coefficients = std::array::from_fn(|i| Coefficient { value: values[i], std: std[i] });
        MethodResult { coefficients: (self.method != Method::None).then_some(coefficients), ..result }
    }

    /// Standard deviations of the coefficients at the end, for a residual of `residual_nt` that fills the band.
    fn std(&self, band_pass: BandPassDesign, start: &Start, residual_nt: f64) -> [f64; TERMS] {
        match self.pipeline.information() {
            None => start.std,
            Some(information) => {
                // Differenced rows are independent already.
                let gain = f64::from(self.pipeline.noise_gain());
                let variance = if gain == 1.0 { band_pass.samples_per_independent() } else { gain };
                let sigma_nt = residual_nt * variance.sqrt();
                let unit = information.unit_std();
                std::array::from_fn(|i| sigma_nt * f64::from(unit[i]) / NT_PER_UNIT[i])
            }
        }
    }
}
