//! The magnetic sensors of a table: fluxgate and scalars.

use towmag_recording::Column;

use super::assigned::{Assigned, Meaning};
use super::columns::told_unit;
use super::names::normalised;
use super::sensors::{Candidate, candidates, factor_by_size, median_of_size};
use super::triples::{self, Triple};
use crate::field::magnitudes;
use crate::source::{SourceColumn, SourceTable};
use crate::units::Dimension;

pub(super) fn assign_flux(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
    if Column::FLUX.iter().any(|axis| meaning.columns.contains_key(axis.name())) {
        return;
    }
    let taken = meaning.taken();
    let mut triples = triples::find(&table.columns);
    triples.retain(|triple| triple.score > 0 && triple.at.iter().all(|at| !used.contains(at) && !taken.contains(at)));
    // A vector that has values comes before one that has none, and one of the Earth's size before any other.
    triples.sort_by_key(|triple| std::cmp::Reverse((is_of_the_earth(table, triple), triple.score)));
    let Some(triple) = triples.first().cloned() else { return };
    if triple.score < 40 && !is_of_the_earth(table, &triple) {
        return;
    }
    let is_likely = |other: &&Triple| other.at == triple.at || other.score >= 10;
    let mut names = triples.iter().filter(is_likely).map(|triple| triple.prefix.clone());
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
    let Ok(axes) = <[&[f64]; 3]>::try_from(axes) else { return false };
    let sizes = magnitudes(axes);
    median_of_size(&sizes).is_some_and(|(median, present)| present > 0.5 && factor_by_size(median).is_some())
}

pub(super) fn assign_scalars(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
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

fn unit_of(column: &SourceColumn, dimension: Dimension) -> Option<f64> {
    told_unit(column).filter(|unit| unit.dimension == dimension).map(|unit| unit.factor)
}
