//! From files to a recording.

use std::borrow::Cow;

use towmag_recording::Column;

use crate::checks;
use crate::draft::{Draft, DraftColumn};
use crate::error::ImportError;
use crate::finding::Finding;
use crate::merge::join;
use crate::open::{Input, Opened, open};
use crate::options::Options;
use crate::part::Part;
use crate::profile::Profile;
use crate::rate::{RATE_HZ, RATE_TOLERANCE};
use crate::recording::{Recording, Report};
use crate::source::FindingKind;

/// The recording of some files: the one with the readings of the field leads, the others are merged into it by time.
///
/// # Errors
///
/// When a file is none that is known, nothing tells the time, or there is no reading at all: always with what to do.
pub fn import(inputs: Vec<Input>, options: &Options) -> Result<Recording, ImportError> {
    let opened = open(inputs, options)?;
    let several = opened.len() > 1;
    let part = |opened: Opened| Part::of(&opened, &of_file(&opened, options, several));
    // One after the other, so that no file is there twice for longer than it takes.
    let parts = opened.into_iter().map(part).collect::<Result<Vec<_>, _>>()?;
    let mut part = join(parts)?;
    move_scalar(&mut part.draft, options.profile.scalar_lag_s);
    part.findings.extend(missing(&part.draft));
    if !part.is_slow() {
        part.findings.extend(checks::check(&part.draft));
    }
    Ok(recording(part))
}

/// The profile of several files is that of the one that leads: it is not for a file that lacks its columns.
fn of_file<'a>(opened: &Opened, options: &'a Options, several: bool) -> Cow<'a, Options> {
    let wanted = options.profile.columns.values().map(|column| &column.from).chain(&options.profile.time.columns);
    let has = |name: &String| {
        opened.source.tables.iter().any(|table| table.columns.iter().any(|column| column.name == *name))
    };
    if !several || wanted.into_iter().all(has) {
        return Cow::Borrowed(options);
    }
    let profile = Profile { dummies: options.profile.dummies.clone(), ..Profile::default() };
    Cow::Owned(Options { profile, units: options.units.clone(), ..Options::default() })
}

/// A scalar that comes late is moved back, straight between its readings.
fn move_scalar(draft: &mut Draft, lag_s: Option<f64>) {
    let Some(lag_s) = lag_s.filter(|lag_s| *lag_s != 0.0) else { return };
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
    let there = |column| draft.numbers(column).is_some_and(|numbers| numbers.iter().any(|number| number.is_finite()));
    let (text, option) = match (there(Column::Scalar), Column::FLUX.into_iter().all(there)) {
        (true, true) => return None,
        (true, false) => ("there is a scalar and no fluxgate: calibrate, replay and diagnose need both", "--flux NAME"),
        (false, true) => {
            ("there is a fluxgate and no scalar: calibrate, replay and diagnose need both", "--scalar NAME")
        }
        (false, false) => (
            "there is neither a scalar nor a fluxgate: only to be merged into a recording",
            "--scalar NAME --flux NAME",
        ),
    };
    Some(Finding::warning(FindingKind::Missing, text).with(option))
}

fn recording(part: Part) -> Recording {
    let source_rate_hz = (part.source_rate_hz * 1e4).round() / 1e4;
    let is_slow = source_rate_hz < RATE_HZ * (1.0 - RATE_TOLERANCE);
    let report = Report {
        schema: 1,
        format: part.format.into(),
        rows_in: part.rows_in,
        rows_out: part.draft.len(),
        rows_invalid: part.draft.invalid.iter().filter(|invalid| **invalid).count(),
        rows_left_out: part.rows_left_out,
        rate_hz: if is_slow { source_rate_hz } else { RATE_HZ },
        source_rate_hz,
        columns: part.columns,
        findings: part.findings,
    };
    Recording { draft: part.draft, profile: part.profile, report }
}
