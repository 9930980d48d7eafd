//! One table on its way into the recording: its columns with their meaning, its rows in order and at their rate.

use std::collections::BTreeMap;

use towmag_recording::Column;

use crate::columns::draft;
use crate::draft::{Draft, DraftValues};
use crate::error::ImportError;
use crate::finding::Finding;
use crate::meaning::{Meaning, Times, assign, times};
use crate::open::{Opened, table};
use crate::options::Options;
use crate::profile::Profile;
use crate::rate::{RATE_HZ, RATE_TOLERANCE, Sampling, is_regular, regular};
use crate::source::{FindingKind, SourceTable};
use crate::{checks, dummies, resample, rows};

/// More bad rows than this are no accident, share.
const MOST_BAD: f64 = 0.1;

/// What became of one table.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) file: String,
    pub(crate) format: &'static str,
    pub(crate) draft: Draft,
    pub(crate) findings: Vec<Finding>,
    pub(crate) profile: Profile,
    pub(crate) rows_in: usize,
    pub(crate) rows_left_out: usize,
    /// Rows a second of the source.
    pub(crate) source_rate_hz: f64,
    /// Columns of the recording, and what they were.
    pub(crate) columns: BTreeMap<String, String>,
}

impl Part {
    /// From a source.
    ///
    /// # Errors
    ///
    /// When nothing tells the times, a column that was asked for is not there, or most rows are bad.
    pub(crate) fn of(opened: &Opened, options: &Options) -> Result<Self, ImportError> {
        let source = &opened.source;
        let (table, chosen) = table(source, options.profile.part.as_deref())?;
        let times = times(&source.file, table, &options.profile.time)?;
        let meaning = assign(&source.file, table, &times.used, options)?;
        let mut findings = opened.findings.clone();
        findings.extend(chosen);
        findings.extend(table.notes.iter().cloned().map(Finding::from));
        findings.extend(meaning.findings.iter().cloned());
        findings.extend(told_dummies(table));
        let named = |(target, assigned): (&String, &crate::meaning::Assigned)| {
            (target.clone(), table.columns[assigned.at].name.clone())
        };
        let mut part = Self {
            file: source.file.clone(),
            format: source.format,
            draft: draft(table, &times, &meaning),
            findings,
            profile: profile(options, opened, table, &times, &meaning),
            rows_in: table.rows,
            rows_left_out: 0,
            source_rate_hz: 0.0,
            columns: meaning.columns.iter().map(named).collect(),
        };
        if !times.profile.columns.is_empty() {
            part.columns.insert("time_s".into(), times.profile.columns.join(" "));
        }
        part.condition(&meaning, options)?;
        Ok(part)
    }

    /// Values and rows put right: dummies, units, axes, order, range, rate.
    fn condition(&mut self, meaning: &Meaning, options: &Options) -> Result<(), ImportError> {
        let draft = &mut self.draft;
        self.findings.extend(dummies::remove(draft, &options.profile.dummies));
        let is_told = [Column::Scalar, Column::FluxX]
            .map(|column| meaning.columns.get(column.name()).is_some_and(|assigned| assigned.is_told));
        let (factor, findings) = checks::settle_units(draft, is_told);
        self.findings.extend(findings);
        for axis in Column::FLUX {
            if let Some(column) = self.profile.columns.get_mut(axis.name()) {
                column.factor *= factor;
            }
        }
        turn_axes(draft, options);
        let ordered = rows::order(draft);
        self.findings.extend(ordered.findings);
        self.rows_left_out = ordered.left_out;
        dummies::invalidate_missing(draft);
        let bad = dummies::invalidate_out_of_range(draft);
        if bad > 0 {
            let text = format!("{bad} rows have a reading outside 1,000 to 100,000 nT and were made invalid");
            self.findings.push(Finding::warning(FindingKind::Dummies, text));
        }
        if (ordered.left_out + bad) as f64 > MOST_BAD * self.rows_in.max(1) as f64 {
            return Err(self.too_bad(bad));
        }
        self.at_10_hz()
    }

    fn too_bad(&self, bad: usize) -> ImportError {
        let rows = self.rows_in;
        let what = if self.rows_left_out > bad {
            let left_out = self.rows_left_out;
            format!(
                "{left_out} of {rows} rows have no time that can be used: is the time in another column (--time NAME)?"
            )
        } else {
            format!(
                "{bad} of {rows} rows have a reading outside 1,000 to 100,000 nT: is it another column (--scalar NAME, --flux NAME), \
                 another unit (--units UNIT), or anomalies instead of a total field, which cannot be compensated?{}",
                self.told_of_units()
            )
        };
        ImportError::file(&self.file, what)
    }

    /// What is known of the units, for a refusal.
    fn told_of_units(&self) -> String {
        let is_of_units = |finding: &&Finding| finding.is_warning && finding.kind == FindingKind::Units;
        let told = |finding: &Finding| {
            let option = finding.option.as_deref().unwrap_or_default();
            format!(" Also, {} ({option}).", finding.text)
        };
        self.findings.iter().filter(is_of_units).map(told).collect()
    }

    /// Regular rows at 10 Hz, or at the source's own rate where that is lower.
    fn at_10_hz(&mut self) -> Result<(), ImportError> {
        let no_rate = || {
            let what = "has fewer than two rows with different times: name their column with --time NAME";
            ImportError::file(&self.file, what)
        };
        let sampling = Sampling::of(&self.draft.time_s).ok_or_else(no_rate)?;
        self.source_rate_hz = sampling.rate_hz();
        if self.is_slow() {
            let text =
                format!("{} Hz: the rows keep their rate, which is too slow to compensate", shown(self.source_rate_hz));
            self.findings.push(Finding::new(FindingKind::Rate, text));
            return Ok(());
        }
        let is_fast = self.source_rate_hz > RATE_HZ * (1.0 + RATE_TOLERANCE);
        let (times, changed) = regular(&self.draft.time_s, &sampling);
        if changed {
            let text = "stamps of a regular sampler that are coarse or jitter were made regular";
            self.findings.push(Finding::new(FindingKind::Rate, text));
            self.draft.time_s = times;
        }
        if is_fast || !is_regular(&self.draft.time_s) {
            let rate = shown(self.source_rate_hz);
            let text = format!("{rate} Hz was resampled to 10 Hz, filtered against aliases, without delay");
            self.findings.push(Finding::new(FindingKind::Rate, text));
            let sampling = Sampling::of(&self.draft.time_s).unwrap_or(sampling);
            self.draft = resample::resample(&self.draft, &sampling);
        }
        Ok(())
    }

    /// Whether its rows come too rarely to compensate.
    pub(crate) fn is_slow(&self) -> bool {
        self.source_rate_hz < RATE_HZ * (1.0 - RATE_TOLERANCE)
    }

    /// Whether it has readings of this sensor.
    pub(crate) fn has(&self, column: Column) -> bool {
        self.draft.numbers(column).is_some_and(|numbers| numbers.iter().any(|number| number.is_finite()))
    }
}

/// Dummies that the format itself tells, where there are any.
fn told_dummies(table: &SourceTable) -> Option<Finding> {
    let missing = |column: &&crate::source::SourceColumn| {
        column.dummy.is_some()
            && column.as_numbers().is_some_and(|numbers| numbers.iter().any(|number| number.is_nan()))
    };
    let told: Vec<String> = table
        .columns
        .iter()
        .filter(missing)
        .filter_map(|column| Some(format!("{} in \"{}\"", column.dummy?, column.name)))
        .take(6)
        .collect();
    let text = format!("the file says what stands for \"missing\": {}", told.join(", "));
    (!told.is_empty()).then(|| Finding::new(FindingKind::Dummies, text))
}

fn shown(rate_hz: f64) -> f64 {
    (rate_hz * 100.0).round() / 100.0
}

fn profile(options: &Options, opened: &Opened, table: &SourceTable, times: &Times, meaning: &Meaning) -> Profile {
    let part = Some(table.name.clone()).filter(|name| !name.is_empty()).or(options.profile.part.clone());
    Profile {
        schema: 1,
        part,
        text: opened.text.clone(),
        time: times.profile.clone(),
        columns: meaning.profile(table),
        ..options.profile.clone()
    }
}

fn turn_axes(draft: &mut Draft, options: &Options) {
    let Some((axes, flux)) = options.profile.axes.zip(draft.flux().map(|axes| axes.map(<[f64]>::to_vec))) else {
        return;
    };
    for (target, axis) in Column::FLUX.into_iter().zip(axes) {
        let turned = flux[axis.of].iter().map(|number| if axis.is_turned { -number } else { *number }).collect();
        if let Some(column) = draft.column_mut(target) {
            column.values = DraftValues::Numbers(turned);
        }
    }
}
