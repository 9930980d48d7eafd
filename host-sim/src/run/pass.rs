//! One pass of a recording through the core, for one method or several at once.

use towmag::estimate::Quality;
use towmag::{Method, Output, Pipeline, Settings};

use super::collectors::{RecordingCollector, Row};
use super::counts::Counts;
use super::method::MethodRun;
use super::result::{MethodResult, Uncompensated};
use super::start::Start;
use crate::error::HostError;
use crate::progress::Progress;
use crate::recording::{Column, RecordingReader, RecordingRow};

/// What a pass gave.
pub struct Passed {
    /// What was counted.
    pub counts: Counts,
    /// The recording before compensation.
    pub uncompensated: Uncompensated,
    /// What each method made of it, in the order asked for.
    pub methods: Vec<MethodResult>,
}

/// A row after the core has seen it.
#[derive(Clone, Copy)]
pub struct PassedRow<'a> {
    /// The recording, whose latest row it is.
    pub recording: &'a dyn RecordingReader,
    /// The row.
    pub row: &'a RecordingRow,
    /// What the first method made of it.
    pub output: &'a Output,
    /// What that says of it.
    pub quality: Option<&'a Quality>,
}

/// Feed a recording through `methods`. `sink` gets every row.
///
/// # Errors
///
/// Those of the recording, the settings and `sink`.
pub fn pass(
    recording: &mut dyn RecordingReader,
    methods: &[Method],
    settings: &Settings,
    start: &Start,
    sink: impl FnMut(PassedRow<'_>) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let runs = methods.iter().map(|&method| MethodRun::new(method, settings, start)).collect::<Result<_, _>>()?;
    pass_runs(recording, runs, settings, start, sink)
}

/// The same with outputs that were made elsewhere, one for each row, and the core as it was after the last of them.
///
/// # Errors
///
/// Those of the recording, the settings and `sink`.
pub fn pass_given(
    recording: &mut dyn RecordingReader,
    settings: &Settings,
    start: &Start,
    pipeline: Pipeline,
    outputs: Vec<Option<Output>>,
    sink: impl FnMut(PassedRow<'_>) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let run = MethodRun::new(settings.method, settings, start)?.given(pipeline, outputs);
    pass_runs(recording, vec![run], settings, start, sink)
}

fn pass_runs(
    recording: &mut dyn RecordingReader,
    mut runs: Vec<MethodRun>,
    settings: &Settings,
    start: &Start,
    mut sink: impl FnMut(PassedRow<'_>) -> Result<(), HostError>,
) -> Result<Passed, HostError> {
    let progress = Progress::of(recording);
    let mut whole = RecordingCollector::new(settings.band_pass.sample_rate_hz);
    let mut counts = Counts {
        recorded_heading: recording.schema().has(Column::Heading),
        session_gaps: recording.session_gaps().to_vec(),
        ..Counts::default()
    };
    let mut row = RecordingRow::default();
    while recording.read_row(&mut row)? {
        counts.count(&row);
        progress.update(recording, counts.rows);
        let mut first = None;
        for run in &mut runs {
            let output = if row.is_on_grid { run.step(&row.epoch) } else { run.pass_over(&row.epoch) };
            if let Some(seen) = seen(&row, &output) {
                if first.is_none() {
                    whole.push(&seen);
                    counts.used_rows += 1;
                }
                run.collect(&seen, &output);
            }
            first.get_or_insert(output);
        }
        if let (Some(output), Some(first)) = (&first, runs.first()) {
            sink(PassedRow { recording, row: &row, output, quality: first.quality() })?;
        }
    }
    counts.bad_rows = recording.bad_rows().cloned().unwrap_or_default();
    let methods = runs.iter().map(|run| run.finish(settings.band_pass, start)).collect();
    Ok(Passed { counts, uncompensated: whole.finish(), methods })
}

/// What the collectors want of a compensated row.
fn seen(row: &RecordingRow, output: &Output) -> Option<Row> {
    let compensated = output.compensated?;
    Some(Row {
        time_s: row.time_s()?,
        heading_deg: heading_deg(row),
        flux_nt: row.flux_nt(),
        scalar_nt: row.scalar_nt()?,
        band_passed_nt: Some(f64::from(compensated.band_passed_nt)),
    })
}

/// The recorded heading, or that of the fluxgate's horizontal part: magnetic, and without levelling.
fn heading_deg(row: &RecordingRow) -> Option<f64> {
    row.number(Column::Heading).or_else(|| row.flux_nt().map(|[x, y, _]| (-y).atan2(x).to_degrees()))
}
