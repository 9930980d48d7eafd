//! Everything but times and magnetic sensors: depth, attitude, position, currents.

use towmag_recording::{Column, ColumnKind};

use super::assigned::{Assigned, Meaning};
use super::columns::told_unit;
use super::names::{self, normalised};
use super::sensors::median_of_size;
use crate::finding::Finding;
use crate::source::{FindingKind, SourceColumn, SourceTable, Values};
use crate::units::{self, Dimension};

/// Everything but the magnetic sensors: each of the recording's columns takes what fits it best.
pub(super) fn assign_others(table: &SourceTable, used: &[usize], meaning: &mut Meaning) {
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
    meaning.findings.extend(told_minutes(table));
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

/// Degrees and minutes in one number, 5400.1234 for 54 degrees 0.1234 minutes, as NMEA has them: they are not taken for
/// degrees, and that is said.
fn told_minutes(table: &SourceTable) -> Option<Finding> {
    let is_minutes = |column: &&SourceColumn| {
        let is_position = [Column::Latitude, Column::Longitude].iter().any(|of| names::fit(*of, &column.name) > 0);
        let median = column.as_numbers().and_then(median_of_size).map(|(median, _)| median);
        is_position && median.is_some_and(|median| median > 361.0 && median < 18_100.0 && median % 100.0 < 60.0)
    };
    let found: Vec<&str> = table.columns.iter().filter(is_minutes).map(|column| column.name.as_str()).collect();
    let text =
        format!("{} look like degrees and minutes in one number and were not taken for a position", found.join(", "));
    (!found.is_empty()).then(|| Finding::warning(FindingKind::Units, text))
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
