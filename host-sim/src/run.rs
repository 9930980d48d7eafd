//! One pass of a recording through the core, for one method or several at once.

use crate::error::HostError;
use crate::progress::Progress;
use crate::recording::{self, RecordingRow};
use crate::report::{Coefficient, MethodCollector, MethodResult, MethodRow, RecordingCollector, Row, Uncompensated};
use crate::summary::AdaptationSummary;
use std::path::Path;
use towmag::estimate::{Adaptation, Prior, Quality};
use towmag::filter::BandPassDesign;
use towmag::model::{NT_PER_UNIT, TERMS};
use towmag::{Epoch, Method, Output, Pipeline, Rejection, Settings, Status};

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

/// Where every method starts from.
#[derive(Clone, Debug)]
pub struct Start {
    /// Coefficients of the calibration, and the information behind them if the file has it.
    pub prior: Prior,
    /// Their standard deviations, in the units of eq. (4).
    pub std: [f64; TERMS],
}

/// What a pass counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Rows read.
    pub rows: u64,
    /// Rows compensated; the figures are of these.
    pub used_rows: u64,
    /// Gaps longer than an epoch.
    pub gaps: u64,
    /// Time lost in gaps, s.
    pub gap_s: f64,
    /// Time of the first and of the last row that has one, s.
    pub span_s: Option<(f64, f64)>,
    /// Whether the recording holds a heading of its own.
    pub recorded_heading: bool,
}

/// What a pass gave.
pub struct Passed {
    /// What was counted.
    pub counts: Counts,
    /// The recording before compensation.
    pub uncompensated: Uncompensated,
    /// What each method made of it, in the order asked for.
    pub methods: Vec<MethodResult>,
}

/// One method in motion.
struct Running {
    method: Method,
    pipeline: Pipeline,
    /// Outputs that were made elsewhere, if they were.
    given: Option<std::vec::IntoIter<Option<Output>>>,
    collector: MethodCollector,
    adaptation: AdaptationCounts,
}

/// What a method said of itself, over the compensated rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdaptationCounts {
    rows: u64,
    variance: f64,
    surprised: u64,
    resting: u64,
    relearning: u64,
    adapted: f32,
}

impl AdaptationCounts {
    fn add(&mut self, quality: &Quality) {
        let Quality { predicted_std_nt, adapted, adaptation } = *quality;
        self.adapted = adapted;
        if adaptation == Adaptation::Waiting {
            return;
        }
        self.rows += 1;
        self.variance += f64::from(predicted_std_nt).powi(2);
        self.surprised += u64::from(adaptation == Adaptation::Surprised);
        self.resting += u64::from(adaptation == Adaptation::Resting);
        self.relearning += u64::from(adaptation == Adaptation::Relearning);
    }

    /// For the summary; `None` for a method that says nothing.
    pub fn summary(&self) -> Option<AdaptationSummary> {
        let share = |count: u64| count as f64 / self.rows as f64;
        (self.rows > 0).then(|| AdaptationSummary {
            predicted_std_nT: (self.variance / self.rows as f64).sqrt(),
            adapted_share: f64::from(self.adapted),
            surprised_share: share(self.surprised),
            resting_share: share(self.resting),
            relearning_share: share(self.relearning),
        })
    }
}

/// Feed a recording through `methods`. `sink` gets every row with the output of the first of them, and what that
/// says of it.
pub fn pass(
    path: &Path,
    methods: &[Method],
    settings: &Settings,
    start: &Start,
    sink: impl FnMut(&RecordingRow, &Output, Option<&Quality>) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let running = methods.iter().map(|&method| Running::new(method, settings, start)).collect::<Result<_, _>>()?;
    pass_running(path, running, settings, start, sink)
}

/// The same with outputs that were made elsewhere, one for each row, and the core as it was after the last of them.
pub fn pass_given(
    path: &Path,
    settings: &Settings,
    start: &Start,
    pipeline: Pipeline,
    outputs: Vec<Option<Output>>,
    mut sink: impl FnMut(&RecordingRow, &Output) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let running = Running::new(settings.method, settings, start)?;
    let given = Some(outputs.into_iter());
    pass_running(path, vec![Running { pipeline, given, ..running }], settings, start, |row, output, _| {
        sink(row, output)
    })
}

fn pass_running(
    path: &Path,
    mut running: Vec<Running>,
    settings: &Settings,
    start: &Start,
    mut sink: impl FnMut(&RecordingRow, &Output, Option<&Quality>) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let mut recording = recording::open(path)?;
    let progress = Progress::of(&*recording);
    let mut whole = RecordingCollector::new(settings.band_pass.sample_rate_hz);
    let mut counts = Counts { recorded_heading: recording.columns().heading_deg.is_some(), ..Counts::default() };
    let mut row = RecordingRow::default();
    while recording.read_row(&mut row)? {
        counts.count(&row);
        progress.update(&*recording, counts.rows);
        let mut first = None;
        for method in &mut running {
            let output = method.step(&row.epoch);
            if let Some(seen) = seen(&row, &output) {
                if first.is_none() {
                    whole.push(&seen);
                    counts.used_rows += 1;
                }
                method.collect(&seen, &output);
            }
            first.get_or_insert(output);
        }
        if let (Some(output), Some(first)) = (first, running.first()) {
            sink(&row, &output, first.quality())?;
        }
    }
    let methods = running.iter().map(|method| method.finish(settings.band_pass, start)).collect();
    Ok(Passed { counts, uncompensated: whole.finish(), methods })
}

impl Counts {
    /// Count a row, whatever becomes of it.
    pub fn count(&mut self, row: &RecordingRow) {
        self.rows += 1;
        if let Some(gap_s) = row.gap_s {
            self.gaps += 1;
            self.gap_s += gap_s;
        }
        if let Some(time_s) = row.time_s {
            self.span_s = Some((self.span_s.map_or(time_s, |(first, _)| first), time_s));
        }
    }
}

/// What the collectors want of a compensated row.
fn seen(row: &RecordingRow, output: &Output) -> Option<Row> {
    let compensated = output.compensated?;
    Some(Row {
        time_s: row.time_s?,
        heading_deg: heading_deg(row),
        scalar_nt: row.scalar_nt?,
        band_passed_nt: Some(f64::from(compensated.band_passed_nt)),
    })
}

/// The recorded heading, or that of the fluxgate's horizontal part: magnetic, and without levelling.
fn heading_deg(row: &RecordingRow) -> Option<f64> {
    row.heading_deg.or_else(|| row.flux_nt.map(|[x, y, _]| (-y).atan2(x).to_degrees()))
}

/// The scalar reading less the interference, nT; to a millionth, which is finer than any sensor.
pub fn difference_nt(scalar_nt: f64, interference_nt: f64) -> f64 {
    ((scalar_nt - interference_nt) * 1e6).round() / 1e6
}

impl Running {
    fn new(method: Method, settings: &Settings, start: &Start) -> Result<Self, HostError> {
        let settings = Settings { method, ..*settings };
        Ok(Self {
            method,
            pipeline: Pipeline::new(&settings, start.prior)?,
            given: None,
            collector: MethodCollector::new(settings.band_pass.sample_rate_hz),
            adaptation: AdaptationCounts::default(),
        })
    }

    fn step(&mut self, epoch: &Epoch) -> Output {
        let Some(given) = &mut self.given else { return self.pipeline.step(epoch) };
        let none = Output { tick: epoch.tick, status: Status::Rejected(Rejection::ScalarMissing), compensated: None };
        given.next().flatten().unwrap_or(none)
    }

    /// What the method says of its latest output. Outputs that were made elsewhere say nothing of themselves.
    fn quality(&self) -> Option<&Quality> {
        if self.given.is_some() { None } else { self.pipeline.quality() }
    }

    fn collect(&mut self, row: &Row, output: &Output) {
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

    fn finish(&self, band_pass: BandPassDesign, start: &Start) -> MethodResult {
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
