//! From files to a recording.

use std::sync::Arc;

use towmag_recording::{Column, ColumnKind};

use crate::draft::{Draft, DraftColumn, DraftValues};
use crate::error::ImportError;
use crate::finding::Finding;
use crate::meaning::{Meaning, Times, assign, times};
use crate::options::Options;
use crate::rate::{RATE_HZ, RATE_TOLERANCE, Sampling, is_regular, regular};
use crate::recording::{Recording, Report};
use crate::source::{FindingKind, Source, SourceTable, Values};
use crate::{checks, dummies, merge, open, resample, rows};

/// More bad rows than this are no accident, share.
const MOST_BAD: f64 = 0.1;

/// A file that was read into memory.
#[derive(Clone, Debug)]
pub struct File {
    /// As the user named it.
    pub name: String,
    /// All of it.
    pub bytes: Vec<u8>,
}

/// The recording of some files: the first with readings of the field is the one that the others are merged into.
///
/// # Errors
///
/// When a file is none that is known, nothing tells the time, or there is no sensor at all: always with what to do.
pub fn import(files: Vec<File>, options: &Options) -> Result<Recording, ImportError> {
    let mut sources = open::open(files, options)?;
    let mut parts = Vec::new();
    for source in &mut sources {
        parts.push(part(source, options)?);
    }
    let mut main = merge::join(parts)?;
    finish(&mut main, options)
}

/// What became of one table.
pub(crate) struct Part {
    pub(crate) file: String,
    pub(crate) format: &'static str,
    pub(crate) draft: Draft,
    pub(crate) meaning: Meaning,
    pub(crate) times: Times,
    pub(crate) findings: Vec<Finding>,
    pub(crate) profile: crate::profile::Profile,
    pub(crate) rows_in: usize,
    pub(crate) columns: std::collections::BTreeMap<String, String>,
    pub(crate) is_told: [bool; 2],
}

fn part(source: &Source, options: &Options) -> Result<Part, ImportError> {
    let (table, mut findings) = open::table(source, options.profile.part.as_deref())?;
    let times = times(&source.file, table, &options.profile.time)?;
    let meaning = assign(&source.file, table, &times.used, options)?;
    findings.extend(table.notes.iter().cloned().map(Finding::from));
    findings.extend(meaning.findings.iter().cloned());
    let draft = draft(table, &times, &meaning);
    let told = |column: Column| meaning.columns.get(column.name()).is_some_and(|assigned| assigned.is_told);
    let columns = meaning.columns.iter().map(|(target, assigned)| (target.clone(), table.columns[assigned.at].name.clone()));
    Ok(Part {
        file: source.file.clone(),
        format: source.format,
        columns: columns.chain(time_column(&times)).collect(),
        profile: profile(options, table, &times, &meaning),
        is_told: [told(Column::Scalar), told(Column::FluxX)],
        rows_in: table.rows,
        draft,
        times,
        findings,
        meaning,
    })
}

fn time_column(times: &Times) -> Option<(String, String)> {
    (!times.profile.columns.is_empty()).then(|| ("time_s".into(), times.profile.columns.join(" ")))
}

fn profile(options: &Options, table: &SourceTable, times: &Times, meaning: &Meaning) -> crate::profile::Profile {
    let mut profile = options.profile.clone();
    profile.schema = 1;
    profile.time = times.profile.clone();
    profile.columns = meaning.profile(table);
    if !table.name.is_empty() {
        profile.part = Some(table.name.clone());
    }
    profile
}

/// The columns in the units of the recording.
fn draft(table: &SourceTable, times: &Times, meaning: &Meaning) -> Draft {
    let mut columns = Vec::new();
    for (target, assigned) in &meaning.columns {
        let known = Column::named(target);
        let is_label = known.is_some_and(|known| known.spec().kind == ColumnKind::Label);
        let (factor, offset) = (assigned.factor, assigned.offset);
        let is_made = factor != 1.0 || offset != 0.0;
        let values = match &table.columns[assigned.at].values {
            Values::Numbers(numbers) | Values::Times(numbers) if is_label => {
                DraftValues::Labels(numbers.iter().map(|number| label(*number)).collect())
            }
            Values::Numbers(numbers) | Values::Times(numbers) if is_made => {
                DraftValues::Numbers(numbers.iter().map(|number| number * factor + offset).collect())
            }
            Values::Numbers(numbers) | Values::Times(numbers) => DraftValues::Numbers(numbers.clone()),
            Values::Text(texts) => DraftValues::Labels(texts.clone()),
        };
        columns.push(DraftColumn { name: target.clone(), known, values, is_made });
    }
    for &at in &meaning.carried {
        let column = &table.columns[at];
        let values = match &column.values {
            Values::Numbers(numbers) | Values::Times(numbers) => DraftValues::Numbers(numbers.clone()),
            Values::Text(texts) => DraftValues::Labels(texts.clone()),
        };
        let name = free_name(&column.name, &columns);
        columns.push(DraftColumn { name, known: None, values, is_made: false });
    }
    let time_s = times.seconds.clone();
    Draft { invalid: vec![false; time_s.len()], time_s, is_utc: times.is_utc, is_clock: times.is_clock, columns }
}

fn label(number: f64) -> Arc<str> {
    if number.is_finite() { format!("{number}").into() } else { "".into() }
}

/// A name that neither the recording's own columns nor another one has.
fn free_name(name: &str, columns: &[DraftColumn]) -> String {
    let is_taken = |name: &str| {
        Column::named(name).is_some()
            || towmag_recording::load_of(name).is_some()
            || columns.iter().any(|column| column.name == name)
    };
    let mut free = name.to_string();
    let mut number = 1;
    while is_taken(&free) {
        number += 1;
        free = format!("{name}_source{}", if number > 2 { number.to_string() } else { String::new() });
    }
    free
}

fn finish(main: &mut Part, options: &Options) -> Result<Recording, ImportError> {
    let mut findings = std::mem::take(&mut main.findings);
    let draft = &mut main.draft;
    findings.extend(dummies::remove(draft, &options.profile.dummies));
    findings.extend(checks::settle_units(draft, main.is_told));
    for (target, column) in &mut main.profile.columns {
        settle_factor(target, column, &main.meaning, draft, &findings);
    }
    turn_axes(draft, options);
    let ordered = rows::order(draft);
    findings.extend(ordered.findings);
    let bad = dummies::invalidate_out_of_range(draft);
    if bad > 0 {
        let text = format!("{bad} rows have a reading outside 1,000 to 100,000 nT and were made invalid");
        findings.push(Finding::new(FindingKind::Dummies, text));
    }
    if (ordered.left_out + bad) as f64 > MOST_BAD * main.rows_in.max(1) as f64 {
        return Err(too_bad(main, ordered.left_out, bad));
    }
    let (recorded, sampling) = at_10_hz(&main.file, &main.draft, options, &mut findings)?;
    let mut recorded = recorded;
    move_scalar(&mut recorded, options);
    findings.extend(missing(&recorded));
    if sampling.as_ref().is_some_and(|sampling| sampling.rate_hz() > RATE_HZ * (1.0 - RATE_TOLERANCE)) {
        findings.extend(checks::check(&recorded));
    }
    Ok(report(main, recorded, sampling, ordered.left_out, findings))
}

/// The profile has the factors that were taken, also those found by comparing.
fn settle_factor(
    target: &str,
    column: &mut crate::profile::ColumnProfile,
    meaning: &Meaning,
    draft: &Draft,
    _findings: &[Finding],
) {
    let Some(known) = Column::named(target).filter(|known| Column::FLUX.contains(known)) else { return };
    let told = meaning.columns.get(target).map_or(1.0, |assigned| assigned.factor);
    column.factor = told * draft.made_factor(known);
}

fn too_bad(main: &Part, left_out: usize, bad: usize) -> ImportError {
    let what = if left_out > bad {
        format!("{left_out} of {} rows have no time that can be used: is the time in another column (--time NAME)?", main.rows_in)
    } else {
        format!(
            "{bad} of {} rows have a reading outside 1,000 to 100,000 nT: is it another column (--scalar NAME, --flux NAME), another unit \
             (--units UNIT), or anomalies instead of a total field, which cannot be compensated?",
            main.rows_in
        )
    };
    ImportError::file(&main.file, what)
}

fn turn_axes(draft: &mut Draft, options: &Options) {
    let (Some(axes), Some(flux)) = (options.profile.axes, draft.flux().map(|axes| axes.map(<[f64]>::to_vec))) else { return };
    for (target, axis) in Column::FLUX.into_iter().zip(axes) {
        let turned = flux[axis.of].iter().map(|number| if axis.is_turned { -number } else { *number }).collect();
        if let Some(column) = draft.column_mut(target) {
            column.values = DraftValues::Numbers(turned);
        }
    }
}

/// Regular rows at 10 Hz, or at the source's own rate where that is lower.
fn at_10_hz(
    file: &str,
    draft: &Draft,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<(Draft, Option<Sampling>), ImportError> {
    let Some(sampling) = Sampling::of(&draft.time_s) else {
        return Err(ImportError::file(file, "has fewer than two rows with different times: name their column with --time NAME"));
    };
    let rate_hz = sampling.rate_hz();
    let is_slow = rate_hz < RATE_HZ * (1.0 - RATE_TOLERANCE);
    let is_fast = rate_hz > RATE_HZ * (1.0 + RATE_TOLERANCE);
    let mut draft = draft.clone();
    if is_fast || !is_regular(&draft.time_s) && !is_slow {
        let (times, changed) = regular(&draft.time_s, &sampling);
        draft.time_s = times;
        if changed {
            findings.push(Finding::new(FindingKind::Rate, "stamps of a regular sampler that are coarse or jitter were made regular"));
        }
    }
    let sampling = Sampling::of(&draft.time_s).unwrap_or(sampling);
    let shown = (rate_hz * 100.0).round() / 100.0;
    if is_slow {
        let text = format!("{shown} Hz is too slow to compensate: 10 Hz or faster is needed; the rows keep their rate");
        findings.push(Finding::warning(FindingKind::Rate, text));
    } else if is_fast || !is_regular(&draft.time_s) {
        let text = format!("{shown} Hz was resampled to 10 Hz, filtered against aliases from 5 Hz on, without delay");
        findings.push(Finding::new(FindingKind::Rate, text));
        draft = resample::resample(&draft, &sampling);
    }
    let _ = options;
    Ok((draft, Some(Sampling { step_s: 1.0 / rate_hz, ..sampling })))
}

/// A scalar that comes late is moved back, straight between its readings.
fn move_scalar(draft: &mut Draft, options: &Options) {
    let Some(lag_s) = options.profile.scalar_lag_s.filter(|lag_s| *lag_s != 0.0) else { return };
    let times = draft.time_s.clone();
    let Some(numbers) = draft.column_mut(Column::Scalar).and_then(DraftColumn::make) else { return };
    let source = numbers.clone();
    for (row, number) in numbers.iter_mut().enumerate() {
        let at_s = times[row] + lag_s;
        let after = times.partition_point(|time_s| *time_s < at_s - 1e-9);
        *number = match (after.checked_sub(1), times.get(after)) {
            (_, Some(time_s)) if (time_s - at_s).abs() <= 1e-9 => source[after],
            (Some(before), Some(time_s)) if time_s - times[before] <= 0.15 + 1e-6 => {
                let share = (at_s - times[before]) / (time_s - times[before]);
                source[before] + share * (source[after] - source[before])
            }
            _ => f64::NAN,
        };
    }
}

/// What the recording lacks, and which commands need it.
fn missing(draft: &Draft) -> Option<Finding> {
    let (scalar, flux) = (draft.numbers(Column::Scalar), draft.flux());
    let there = |numbers: Option<&[f64]>| numbers.is_some_and(|numbers| numbers.iter().any(|number| number.is_finite()));
    let (text, option) = match (there(scalar), there(flux.map(|flux| flux[0]))) {
        (true, true) => return None,
        (true, false) => ("has a scalar and no fluxgate: it cannot be compensated, calibrated or diagnosed", "--flux NAME"),
        (false, true) => ("has a fluxgate and no scalar: it cannot be compensated, calibrated or diagnosed", "--scalar NAME"),
        (false, false) => ("has neither a scalar nor a fluxgate: it can only be merged into a recording", "--scalar NAME --flux NAME"),
    };
    Some(Finding::warning(FindingKind::Missing, text).with(option))
}

fn report(main: &Part, draft: Draft, sampling: Option<Sampling>, left_out: usize, findings: Vec<Finding>) -> Recording {
    let source_rate_hz = sampling.map(|sampling| (sampling.rate_hz() * 1e4).round() / 1e4);
    let own = source_rate_hz.filter(|rate| *rate < RATE_HZ * (1.0 - RATE_TOLERANCE));
    let cut = main.meaning.carried.len();
    let _ = cut;
    let report = Report {
        schema: 1,
        format: main.format.into(),
        rows_in: main.rows_in,
        rows_out: draft.len(),
        rows_invalid: draft.invalid.iter().filter(|invalid| **invalid).count(),
        rows_left_out: left_out,
        rate_hz: Some(own.unwrap_or(RATE_HZ)),
        source_rate_hz,
        columns: main.columns.clone(),
        findings,
    };
    Recording { draft, profile: main.profile.clone(), report }
}
