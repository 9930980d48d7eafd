//! Which column of a source becomes which column of the recording.

use std::collections::BTreeMap;

use towmag_recording::{Column, ColumnKind};

use super::asked;
use super::names::{self, normalised};
use super::sensors::{Candidate, candidates, factor_by_size, median_of_size};
use super::triples::{self, Triple};
use crate::error::ImportError;
use crate::finding::Finding;
use crate::options::Options;
use crate::profile::ColumnProfile;
use crate::source::{FindingKind, SourceColumn, SourceTable, Values};
use crate::units::{self, Dimension};

/// What the columns of a table mean.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meaning {
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
pub struct Assigned {
    /// Which column of the table.
    pub at: usize,
    /// Times this, to the unit of the recording.
    pub factor: f64,
    /// Plus this.
    pub offset: f64,
    /// Whether the unit was asked for, told by the file, or needs no telling.
    pub is_told: bool,
}

/// What each column of a table means; `used` are those of the times.
///
/// # Errors
///
/// When a column is asked for that is not there, or holds no numbers.
pub fn assign(file: &str, table: &SourceTable, used: &[usize], options: &Options) -> Result<Meaning, ImportError> {
    let mut meaning = Meaning::default();
    asked::assign(file, table, options, &mut meaning)?;
    assign_flux(table, used, &mut meaning);
    assign_scalars(table, used, &mut meaning);
    assign_others(table, used, &mut meaning);
    if let Some(factor) = meaning.field_factor {
        let sensors = Column::FLUX.into_iter().chain([Column::Scalar, Column::Scalar2]);
        for column in sensors {
            if let Some(assigned) = meaning.columns.get_mut(column.name()) {
                (assigned.factor, assigned.is_told) = (factor, true);
            }
        }
    }
    let taken = meaning.taken();
    let is_left = |at: &usize| !taken.contains(at) && !used.contains(at) && !is_empty(&table.columns[*at]);
    meaning.carried = (0..table.columns.len()).filter(is_left).collect();
    Ok(meaning)
}

impl Meaning {
    fn taken(&self) -> Vec<usize> {
        self.columns.values().map(|assigned| assigned.at).collect()
    }

    /// For the profile.
    pub fn profile(&self, table: &SourceTable) -> BTreeMap<String, ColumnProfile> {
        let entry = |(target, assigned): (&String, &Assigned)| {
            let Assigned { at, factor, offset, .. } = *assigned;
            (target.clone(), ColumnProfile { from: table.columns[at].name.clone(), factor, offset })
        };
        self.columns.iter().map(entry).collect()
    }
}

/// A column without a name in which nothing stands: a delimiter at the end of each line.
fn is_empty(column: &SourceColumn) -> bool {
    column.name.starts_with("column_")
        && match &column.values {
            Values::Numbers(numbers) | Values::Times(numbers) => numbers.iter().all(|number| number.is_nan()),
            Values::Text(texts) => texts.iter().all(|text| text.is_empty()),
        }
}

fn assign_flux(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
    if Column::FLUX.iter().any(|axis| meaning.columns.contains_key(axis.name())) {
        return;
    }
    let taken = meaning.taken();
    let mut triples = triples::find(&table.columns);
    triples.retain(|triple| triple.score >= 10 && triple.at.iter().all(|at| !used.contains(at) && !taken.contains(at)));
    // A vector that has values comes before one that has none, and one of the Earth's size before any other.
    triples.sort_by_key(|triple| std::cmp::Reverse((is_of_the_earth(table, triple), triple.score)));
    let Some(triple) = triples.first().cloned() else { return };
    if triple.score < 40 && !is_of_the_earth(table, &triple) {
        return;
    }
    let mut names = triples.iter().map(|triple| triple.prefix.clone());
    let (first, others) = (names.next().unwrap_or_default(), names.collect::<Vec<_>>());
    meaning.choice("fluxgate", &first, &others, "--flux");
    for (axis, at) in Column::FLUX.iter().zip(triple.at) {
        let unit = unit_of(&table.columns[at], Dimension::Field);
        let assigned = Assigned { at, factor: unit.unwrap_or(1.0), offset: 0.0, is_told: unit.is_some() };
        meaning.columns.insert(axis.name().into(), assigned);
    }
}

/// Whether the size of a vector is the Earth's in one of the units in use.
fn is_of_the_earth(table: &SourceTable, triple: &Triple) -> bool {
    let axes: Vec<&[f64]> = triple.at.iter().filter_map(|&at| table.columns[at].as_numbers()).collect();
    let [x, y, z] = axes.as_slice() else { return false };
    let sizes: Vec<f64> =
        (0..table.rows).map(|row| (x[row].powi(2) + y[row].powi(2) + z[row].powi(2)).sqrt()).collect();
    median_of_size(&sizes).is_some_and(|(median, present)| present > 0.5 && factor_by_size(median).is_some())
}

fn assign_scalars(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
    // An axis of a vector is no total field, whichever vector was taken.
    let axes = triples::find(&table.columns).into_iter().filter(|triple| triple.score > 0).flat_map(|triple| triple.at);
    let taken: Vec<usize> = meaning.taken().into_iter().chain(used.iter().copied()).chain(axes).collect();
    let found = candidates(&table.columns, &taken);
    let Some(best) = found.first().copied() else { return };
    let name = |candidate: &Candidate| table.columns[candidate.at].name.clone();
    let others: Vec<Candidate> = found[1..].iter().filter(|other| other.score + 30 > best.score).copied().collect();
    if !meaning.columns.contains_key(Column::Scalar.name()) {
        let names: Vec<String> = others.iter().map(name).collect();
        meaning.choice("scalar", &name(&best), &names, "--scalar");
        meaning.insert_scalar(Column::Scalar, best);
    }
    let is_second = |candidate: &&Candidate| {
        let name = normalised(&table.columns[candidate.at].name);
        !meaning.taken().contains(&candidate.at)
            && (name.contains('2') || name.contains("second") || name.contains("bottom"))
    };
    let second = found.iter().find(is_second).copied();
    if let Some(second) = second.filter(|_| !meaning.columns.contains_key(Column::Scalar2.name())) {
        meaning.insert_scalar(Column::Scalar2, second);
    }
}

impl Meaning {
    fn insert_scalar(&mut self, column: Column, candidate: Candidate) {
        let Candidate { at, factor, is_sure, .. } = candidate;
        self.columns.insert(column.name().into(), Assigned { at, factor, offset: 0.0, is_told: is_sure });
    }

    fn choice(&mut self, sensor: &str, taken: &str, others: &[String], option: &str) {
        if let Some(other) = others.first() {
            let all = others.iter().take(6).map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let text = format!("{sensor}: \"{taken}\" was taken; {all} would do as well");
            self.findings.push(Finding::new(FindingKind::Choice, text).with(format!("{option} {other}")));
        }
    }
}

/// Everything but the magnetic sensors: each of the recording's columns takes what fits it best.
fn assign_others(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
    for column in Column::all().filter(|column| *column != Column::Time) {
        if meaning.columns.contains_key(column.name()) {
            continue;
        }
        let taken = meaning.taken();
        let free = |at: &usize| !taken.contains(at) && (!used.contains(at) || *column.name() == *"utc_s");
        if column == Column::Altitude && has_receiver(table) {
            continue;
        }
        let fitting = (0..table.columns.len()).filter(free).filter(|&at| holds(&table.columns[at], column));
        let best = fitting
            .map(|at| (names::fit(column, &table.columns[at].name), at))
            .max_by_key(|(fit, at)| (*fit, usize::MAX - at));
        if let Some((1.., at)) = best {
            let (factor, offset) = conversion(&table.columns[at], column);
            meaning.columns.insert(column.name().into(), Assigned { at, factor, offset, is_told: true });
        }
    }
    for (at, column) in table.columns.iter().enumerate() {
        let unit = column.unit.as_deref().and_then(units::of);
        let is_current = unit.is_some_and(|unit| unit.dimension == Dimension::Current);
        let free = !meaning.taken().contains(&at) && !used.contains(&at) && column.as_numbers().is_some();
        if let Some(load) = names::load(&column.name, is_current).filter(|_| free) {
            let target = format!("current_{load}_A");
            let factor = unit.filter(|_| is_current).map_or(1.0, |unit| unit.factor);
            meaning.columns.entry(target).or_insert(Assigned { at, factor, offset: 0.0, is_told: true });
        }
    }
}

/// Whether the columns of a GPS receiver are there: then an altitude is its own, and none above the bottom.
fn has_receiver(table: &SourceTable) -> bool {
    let tells = |name: &str| ["satellites", "hdop", "fix", "gga", "ellipsoid"].iter().any(|word| name.contains(word));
    table.columns.iter().any(|column| tells(&normalised(&column.name)))
}

/// Whether a column can be this one by what its values are; a speed without a unit may be in knots.
fn holds(source: &SourceColumn, column: Column) -> bool {
    match (column.spec().kind, &source.values) {
        (ColumnKind::Label, _) => true,
        (ColumnKind::Number | ColumnKind::Flag, Values::Numbers(numbers)) => {
            let limit = match column {
                Column::Latitude => 90.0,
                Column::Longitude => 361.0,
                Column::Speed => return told_unit(source).is_some(),
                _ => return true,
            };
            median_of_size(numbers).is_none_or(|(median, _)| median <= limit || source.unit.is_some())
        }
        _ => false,
    }
}

/// To the unit of the recording, from what the file says of its own.
fn conversion(source: &SourceColumn, column: Column) -> (f64, f64) {
    let Some(target) = units::of(column.spec().unit) else { return (1.0, 0.0) };
    let told = told_unit(source).filter(|unit| unit.dimension == target.dimension);
    told.map_or((1.0, 0.0), |unit| (unit.factor, unit.offset))
}

/// The unit that a file tells of a column, beside its name or in it.
pub(super) fn told_unit(source: &SourceColumn) -> Option<units::Unit> {
    source.unit.as_deref().and_then(units::of).or_else(|| units::suffix(&source.name))
}

fn unit_of(column: &SourceColumn, dimension: Dimension) -> Option<f64> {
    told_unit(column).filter(|unit| unit.dimension == dimension).map(|unit| unit.factor)
}
