//! What was found of the columns of a table.

use std::collections::BTreeMap;

use towmag_recording::Column;

use super::sensors::Candidate;
use crate::finding::Finding;
use crate::profile::ColumnProfile;
use crate::source::{FindingKind, SourceTable};

/// What the columns of a table mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Meaning {
    /// Columns of the recording by name, with where each comes from.
    pub columns: BTreeMap<String, Assigned>,
    /// Columns of the table that are carried under their own names.
    pub carried: Vec<usize>,
    /// Factor to nT of the unit that was asked for.
    pub field_factor: Option<f64>,
    /// What was found on the way.
    pub findings: Vec<Finding>,
}

/// Where a column of the recording comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assigned {
    /// Which column of the table.
    pub at: usize,
    /// Times this, to the unit of the recording.
    pub factor: f64,
    /// Plus this.
    pub offset: f64,
    /// Whether the unit was asked for, told by the file, or needs no telling.
    pub is_told: bool,
}

impl Meaning {
    pub(super) fn taken(&self) -> Vec<usize> {
        self.columns.values().map(|assigned| assigned.at).collect()
    }

    /// For the profile.
    pub(crate) fn profile(&self, table: &SourceTable) -> BTreeMap<String, ColumnProfile> {
        let entry = |(target, assigned): (&String, &Assigned)| {
            let Assigned { at, factor, offset, .. } = *assigned;
            (target.clone(), ColumnProfile { from: table.columns[at].name.clone(), factor, offset })
        };
        self.columns.iter().map(entry).collect()
    }

    pub(super) fn insert_scalar(&mut self, column: Column, candidate: Candidate) {
        let Candidate { at, factor, is_sure, .. } = candidate;
        self.columns.insert(column.name().into(), Assigned { at, factor, offset: 0.0, is_told: is_sure });
    }

    pub(super) fn choice(&mut self, sensor: &str, taken: &str, others: &[String], option: &str) {
        if let Some(other) = others.first() {
            let all = others.iter().take(6).map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let text = format!("{sensor}: \"{taken}\" was taken; {all} would do as well");
            self.findings.push(Finding::new(FindingKind::Choice, text).with(format!("{option} {other}")));
        }
    }
}
