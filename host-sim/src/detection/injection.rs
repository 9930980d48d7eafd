//! Every method twice through a recording: with anomalies and without.

use towmag::filter::{BandPass, BandPassState};
use towmag::{Epoch, Method, Output, Pipeline, Settings};

use super::bound::Bound;
use super::figures::{Detection, Sides, Sums};
use super::targets::injected_targets;
use crate::error::HostError;
use crate::recording::{Column, Input, RecordingRow};
use crate::run::{Start, method_name};
use crate::simulator::Target;

/// Time from the peak of an anomaly within which a row counts as part of it, s: it rings in the band-pass for so long.
const AROUND_S: f64 = 10.0;

/// What is injected, and which rows count.
#[derive(Clone, Debug, Default)]
pub struct InjectionSettings {
    /// How many anomalies.
    pub anomalies: usize,
    /// Seed of their places, heights and widths.
    pub seed: u64,
    /// Only rows whose column `line` says so count; all when `None`.
    pub line: Option<String>,
    /// Time after the first row that counts which does not count itself, s.
    pub skip_s: f64,
}

/// The hindsight bound of the rows that count, nT, and the figures of every method against it.
pub fn detection_of_injected(
    input: &Input,
    methods: &[Method],
    settings: &Settings,
    start: &Start,
    injection: &InjectionSettings,
) -> Result<(f64, Vec<Detection>), HostError> {
    let span = counted_span(input, injection)?;
    let targets = injected_targets(injection.anomalies, span, injection.seed);
    let mut bound = Bound::new(settings.band_pass).map_err(towmag::SettingsError::from)?;
    let mut pairs = methods
        .iter()
        .map(|&method| Pair::new(method, settings, start, &targets))
        .collect::<Result<Vec<_>, HostError>>()?;
    each_row(input, injection, |row, counts| {
        let counts = counts && row.time_s().is_some_and(|time_s| time_s >= span.0);
        bound.step(&row.epoch, counts);
        let anomaly_nt = row.time_s().map_or(0.0, |time_s| targets.iter().map(|t: &Target| t.anomaly_nt(time_s)).sum());
        let around = |t: &Target| row.time_s().is_some_and(|time_s| (time_s - t.time_s).abs() <= AROUND_S);
        let anomaly = targets.iter().position(around);
        pairs.iter_mut().for_each(|pair| pair.step(&row.epoch, (anomaly, anomaly_nt), counts));
    })?;
    let bound_nt = bound.rms_nt();
    Ok((bound_nt, pairs.iter().map(|pair| pair.sums.finish(pair.name, bound_nt)).collect()))
}

/// Feed every row, and whether its line counts.
fn each_row(
    input: &Input,
    injection: &InjectionSettings,
    mut sink: impl FnMut(&RecordingRow, bool),
) -> Result<(), HostError> {
    let mut recording = input.open()?;
    if let (Some(line), false) = (&injection.line, recording.schema().has(Column::Line)) {
        return Err(HostError::Usage(format!("--line {line}: {} has no column line", input.shown())));
    }
    let mut row = RecordingRow::default();
    while recording.read_row(&mut row)? {
        if !row.is_on_grid {
            continue;
        }
        sink(&row, injection.line.as_ref().is_none_or(|line| row.line == *line));
    }
    Ok(())
}

/// Time of the first and of the last row that counts, s.
fn counted_span(input: &Input, injection: &InjectionSettings) -> Result<(f64, f64), HostError> {
    let mut span: Option<(f64, f64)> = None;
    each_row(input, injection, |row, counts| {
        if let (true, Some(time_s)) = (counts, row.time_s()) {
            span = Some((span.map_or(time_s, |(first_s, _)| first_s), time_s));
        }
    })?;
    let (first_s, last_s) = span.ok_or_else(|| {
        HostError::NotEnough(format!("{}: no row of line {:?}", input.shown(), injection.line.as_deref().unwrap_or("")))
    })?;
    Ok((first_s + injection.skip_s, last_s))
}

/// One method without and with anomalies.
struct Pair {
    name: &'static str,
    plain: Pipeline,
    disturbed: Pipeline,
    band_pass: BandPass,
    compensated: Option<(i32, BandPassState<1>)>,
    sums: Sums,
}

impl Pair {
    fn new(method: Method, settings: &Settings, start: &Start, targets: &[Target]) -> Result<Self, HostError> {
        let pipeline = Pipeline::new(&Settings { method, ..*settings }, start.prior)?;
        Ok(Self {
            name: method_name(method),
            plain: pipeline.clone(),
            disturbed: pipeline,
            band_pass: settings.band_pass.build().map_err(towmag::SettingsError::from)?,
            compensated: None,
            sums: Sums::new(targets.iter().map(|target| target.peak_nt)),
        })
    }

    fn step(&mut self, epoch: &Epoch, (anomaly, anomaly_nt): (Option<usize>, f64), counts: bool) {
        let anomaly_pt = (anomaly_nt * 1000.0).round() as i32;
        let disturbed = Epoch { scalar_pt: epoch.scalar_pt.map(|pt| pt.saturating_add(anomaly_pt)), ..*epoch };
        let (plain, disturbed) = (self.plain.step(epoch), self.disturbed.step(&disturbed));
        let end_to_end_nt = self.end_to_end_nt(&plain);
        let (Some(plain), Some(disturbed)) = (plain.compensated, disturbed.compensated) else { return };
        if counts {
            self.sums.add(&Sides {
                anomaly,
                residual_nt: plain.residual_nt.into(),
                end_to_end_nt,
                anomaly_nt: f64::from(disturbed.band_passed_nt) - f64::from(plain.band_passed_nt),
                passed_nt: f64::from(disturbed.residual_nt) - f64::from(plain.residual_nt),
            });
        }
    }

    /// The compensated reading, band-passed as whoever looks for targets would; started in steady state.
    fn end_to_end_nt(&mut self, output: &Output) -> f64 {
        let Some(compensated) = output.compensated else { return 0.0 };
        let pt = compensated.compensated_pt;
        let (reference_pt, state) = self.compensated.get_or_insert((pt, BandPassState::steady(&[0.0])));
        let [filtered] = self.band_pass.step(state, &[(pt - *reference_pt) as f32 / 1000.0]);
        filtered.into()
    }
}
