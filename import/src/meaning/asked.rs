//! Columns that a person asks for.

use towmag_recording::Column;

use super::assigned::{Assigned, Meaning};
use super::columns::{position, told_unit, unknown};
use super::names::normalised;
use super::sensors::{factor_by_size, median_of_size};
use super::triples;
use crate::error::ImportError;
use crate::options::Options;
use crate::source::SourceTable;
use crate::units::{self, Dimension};

/// What profile and options name, before anything is looked for. A file that lacks a column of the profile, where several are
/// imported, is another one's.
pub(super) fn assign(
    file: &str,
    table: &SourceTable,
    options: &Options,
    meaning: &mut Meaning,
) -> Result<(), ImportError> {
    let field = options.units.as_deref().map(field_unit).transpose()?;
    for (target, column) in &options.profile.columns {
        let at = position(table, &column.from).ok_or_else(|| unknown(file, table, &column.from))?;
        let is_told = column.factor != 1.0;
        meaning.columns.insert(target.clone(), Assigned { at, factor: column.factor, offset: column.offset, is_told });
    }
    for (target, name) in &options.map {
        let at = position(table, name).ok_or_else(|| unknown(file, table, name))?;
        meaning
            .columns
            .insert(target.clone(), told(table, at, Column::named(target).and_then(|c| units::of(c.spec().unit))));
    }
    if let Some(name) = &options.scalar {
        let at = numbers(file, table, name)?;
        meaning.columns.insert(Column::Scalar.name().into(), magnetic(table, at));
    }
    if let Some(flux) = &options.flux {
        for (axis, at) in Column::FLUX.iter().zip(vector(file, table, flux)?) {
            let unit = told(table, at, units::of("nT"));
            meaning.columns.insert(axis.name().into(), unit);
        }
    }
    meaning.field_factor = field;
    Ok(())
}

/// Factor to nT of a unit that was asked for.
fn field_unit(unit: &str) -> Result<f64, ImportError> {
    let found = units::of(unit).filter(|unit| unit.dimension == Dimension::Field);
    found.map(|unit| unit.factor).ok_or_else(|| {
        ImportError::Usage(format!("--units {unit}: is no unit of a magnetic field: nT, uT, mT, T, G, mG, gamma"))
    })
}

fn numbers(file: &str, table: &SourceTable, name: &str) -> Result<usize, ImportError> {
    let at = position(table, name).ok_or_else(|| unknown(file, table, name))?;
    let is_number = table.columns[at].as_numbers().is_some();
    is_number
        .then_some(at)
        .ok_or_else(|| ImportError::file(file, format!("the column \"{name}\" holds no numbers: name another")))
}

/// Three names with commas, or what the names of a vector have in common.
fn vector(file: &str, table: &SourceTable, flux: &str) -> Result<[usize; 3], ImportError> {
    let names: Vec<&str> = flux.split(',').map(str::trim).collect();
    if let [x, y, z] = names.as_slice() {
        return Ok([numbers(file, table, x)?, numbers(file, table, y)?, numbers(file, table, z)?]);
    }
    let triples = triples::find(&table.columns);
    let wanted = normalised(flux);
    let found = triples
        .iter()
        .find(|triple| triple.prefix == wanted || normalised(&table.columns[triple.at[0]].name) == wanted);
    found.map(|triple| triple.at).ok_or_else(|| {
        let there: Vec<&str> =
            triples.iter().filter(|triple| triple.score > 0).map(|triple| triple.prefix.as_str()).collect();
        let what = format!(
            "has no vector \"{flux}\"; it has {}; or give three names, as in --flux bx,by,bz",
            if there.is_empty() { "none that is recognised".into() } else { there.join(", ") }
        );
        ImportError::file(file, what)
    })
}

/// In the unit that the file tells, if it is of this kind.
fn told(table: &SourceTable, at: usize, target: Option<units::Unit>) -> Assigned {
    let unit =
        told_unit(&table.columns[at]).filter(|unit| target.is_some_and(|target| target.dimension == unit.dimension));
    Assigned {
        at,
        factor: unit.map_or(1.0, |unit| unit.factor),
        offset: unit.map_or(0.0, |unit| unit.offset),
        is_told: unit.is_some(),
    }
}

/// A scalar in the unit that the file tells, else in the one that its size tells.
fn magnetic(table: &SourceTable, at: usize) -> Assigned {
    let told = told(table, at, units::of("nT"));
    if told.is_told {
        return told;
    }
    let size = table.columns[at].as_numbers().and_then(median_of_size).and_then(|(median, _)| factor_by_size(median));
    Assigned { factor: size.unwrap_or(1.0), is_told: size == Some(1.0), ..told }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::ColumnProfile;
    use crate::source::SourceColumn;

    fn table() -> SourceTable {
        let mut columns: Vec<_> = ["B1x", "B1y", "B1z", "B2x", "B2y", "B2z"]
            .map(|name| SourceColumn::numbers(name, vec![30_000.0; 9]).in_unit("nT"))
            .into();
        columns.push(SourceColumn::numbers("Top", vec![50.0; 9]));
        columns.push(SourceColumn::numbers("Deep", vec![10.0; 9]).in_unit("ft"));
        let values = crate::source::Values::Text(vec!["north".into(); 9]);
        columns.push(SourceColumn { name: "leg".into(), unit: None, values, dummy: None });
        SourceTable { rows: 9, columns, ..SourceTable::default() }
    }

    fn asked(options: &Options) -> Result<Meaning, ImportError> {
        let mut meaning = Meaning::default();
        assign("a.csv", &table(), options, &mut meaning).map(|()| meaning)
    }

    fn scalar(name: &str) -> Options {
        Options { scalar: Some(name.into()), ..Options::default() }
    }

    fn flux(name: &str) -> Options {
        Options { flux: Some(name.into()), ..Options::default() }
    }

    #[test]
    fn a_vector_is_named_by_what_its_names_share_or_by_all_three() {
        let at = |options: &Options| {
            let meaning = asked(options).unwrap();
            Column::FLUX.map(|axis| meaning.columns[axis.name()].at)
        };
        for (name, wanted) in [("B2", [3, 4, 5]), ("b2x", [3, 4, 5]), ("B1z, B1x ,B1y", [2, 0, 1])] {
            assert_eq!(at(&flux(name)), wanted, "{name}");
        }
    }

    #[test]
    fn units_are_told_or_go_by_the_size() {
        let top = asked(&scalar("top")).unwrap().columns["scalar_nT"].clone();
        assert_eq!((top.at, top.factor, top.is_told), (6, 1e3, false));
        let map = vec![("depth_m".to_string(), "Deep".to_string())];
        let deep = asked(&Options { map, ..Options::default() }).unwrap().columns["depth_m"].clone();
        assert_eq!((deep.at, deep.factor, deep.is_told), (7, 0.3048, true));
        let units = Options { units: Some("uT".into()), ..Options::default() };
        assert_eq!(asked(&units).unwrap().field_factor, Some(1e3));
    }

    #[test]
    fn what_is_not_there_is_answered_with_what_is() {
        let mut lacking = Options::default();
        let column = ColumnProfile { from: "Mag".into(), factor: 1.0, offset: 0.0 };
        lacking.profile.columns.insert("scalar_nT".into(), column);
        let map = vec![("depth_m".to_string(), "tiefe".to_string())];
        for (options, wanted) in [
            (lacking, "has no column \"Mag\"; it has B1x"),
            (scalar("mag"), "has no column \"mag\"; it has B1x"),
            (scalar("leg"), "holds no numbers: name another"),
            (flux("B3"), "it has b1, b2; or give three names, as in --flux bx,by,bz"),
            (flux("B1x,B1y,leg"), "holds no numbers: name another"),
            (Options { map, ..Options::default() }, "has no column \"tiefe\""),
            (Options { units: Some("m".into()), ..Options::default() }, "nT, uT, mT, T, G, mG, gamma"),
        ] {
            let refusal = asked(&options).unwrap_err().to_string();
            assert!(refusal.contains(wanted), "{refusal}");
        }
    }
}
