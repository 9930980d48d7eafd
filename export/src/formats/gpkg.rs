//! OGC GeoPackage 1.3 (<https://www.geopackage.org/spec130/>): `samples`, a point a row with all columns, and `track`, a
//! line a leg. An SQLite file, made in memory.

use rusqlite::types::Value;
use rusqlite::{Connection, MAIN_DB, Result, Transaction, params, params_from_iter};

use self::geometry::{line, point};
use super::track::LegFacts;
use crate::error::ExportError;
use crate::legs::legs;
use crate::position::Position;
use crate::table::{Table, TableColumn, Values};

mod geometry;
mod names;

/// Tables that every GeoPackage has, with the reference systems that it must have.
const BASE: &str = include_str!("gpkg/base.sql");

/// WGS 84, longitude and latitude.
const SRS_WGS84: i32 = 4326;
/// What the specification has for a grid that nobody has named.
const SRS_UNDEFINED_CARTESIAN: i32 = -1;

/// A table of features.
struct Layer {
    name: &'static str,
    geometry: &'static str,
    /// The columns beside key and geometry: names that can be quoted, and types.
    columns: Vec<(String, &'static str)>,
}

/// The table as a file.
pub(crate) fn encode(table: &Table) -> std::result::Result<Vec<u8>, ExportError> {
    let position = Position::on_a_map(table)?;
    write(table, &position).map_err(ExportError::encoding("gpkg"))
}

fn write(table: &Table, position: &Position<'_>) -> Result<Vec<u8>> {
    let mut database = Connection::open_in_memory()?;
    database.execute_batch(BASE)?;
    let srs_id = if position.is_wgs84 { SRS_WGS84 } else { SRS_UNDEFINED_CARTESIAN };
    let transaction = database.transaction()?;
    write_samples(&transaction, table, position, srs_id)?;
    write_track(&transaction, table, position, srs_id)?;
    transaction.commit()?;
    Ok(database.serialize(MAIN_DB)?.to_vec())
}

fn write_samples(database: &Transaction<'_>, table: &Table, position: &Position<'_>, srs_id: i32) -> Result<()> {
    let names = names::of_columns(table).into_iter();
    let columns = names.zip(&table.columns).map(|(name, column)| (name, sql_type(column))).collect();
    let layer = Layer { name: "samples", geometry: "POINT", columns };
    create(database, &layer, position, srs_id)?;
    let mut insert = database.prepare(&insertion(&layer))?;
    for row in 0..table.len() {
        let geometry = position.at(row).map_or(Value::Null, |place| Value::Blob(point(srs_id, place)));
        let values = table.columns.iter().map(|column| value(&column.values, row));
        insert.execute(params_from_iter(std::iter::once(geometry).chain(values)))?;
    }
    Ok(())
}

fn write_track(database: &Transaction<'_>, table: &Table, position: &Position<'_>, srs_id: i32) -> Result<()> {
    let columns = [
        ("line", "TEXT"),
        ("start_time_s", "DOUBLE"),
        ("end_time_s", "DOUBLE"),
        ("start_utc_s", "DOUBLE"),
        ("end_utc_s", "DOUBLE"),
        ("n", "INTEGER"),
    ];
    let columns = columns.map(|(name, sql)| (name.to_string(), sql)).to_vec();
    let layer = Layer { name: "track", geometry: "LINESTRING", columns };
    create(database, &layer, position, srs_id)?;
    let mut insert = database.prepare(&insertion(&layer))?;
    for leg in legs(table) {
        let places: Vec<[f64; 2]> = leg.rows.clone().filter_map(|row| position.at(row)).collect();
        // One position is no line.
        let geometry = (places.len() > 1).then(|| line(srs_id, &places));
        let LegFacts { line, time_s: [start, end], utc_s: [start_utc, end_utc], rows } = LegFacts::of(table, &leg);
        let rows = i64::try_from(rows).ok();
        insert.execute(params![geometry, line, start, end, start_utc, end_utc, rows])?;
    }
    Ok(())
}

fn create(database: &Transaction<'_>, layer: &Layer, position: &Position<'_>, srs_id: i32) -> Result<()> {
    let Layer { name, geometry, columns } = layer;
    let [key, geom] = names::own(columns);
    let columns: String = columns.iter().map(|(name, sql)| format!(", {name} {sql}")).collect();
    database.execute_batch(&format!(
        "CREATE TABLE {name} ({key} INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, {geom} {geometry}{columns})"
    ))?;
    let [x, y] = [position.x, position.y].map(extent);
    database.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, min_x, min_y, max_x, max_y, srs_id) \
         VALUES (?1, 'features', ?1, ?2, ?3, ?4, ?5, ?6)",
        params![name, x[0], y[0], x[1], y[1], srs_id],
    )?;
    database.execute(
        "INSERT INTO gpkg_geometry_columns VALUES (?1, ?2, ?3, ?4, 0, 0)",
        params![name, geom.trim_matches('"'), geometry, srs_id],
    )?;
    Ok(())
}

fn insertion(Layer { name, columns, .. }: &Layer) -> String {
    let values: String = (0..columns.len()).map(|_| ", ?").collect();
    format!("INSERT INTO {name} VALUES (NULL, ?{values})")
}

fn sql_type(column: &TableColumn) -> &'static str {
    match column.values {
        Values::Number(_) => "DOUBLE",
        Values::Flag(_) => "BOOLEAN",
        Values::Label(_) => "TEXT",
    }
}

fn value(values: &Values, row: usize) -> Value {
    match values {
        Values::Number(numbers) if numbers[row].is_nan() => Value::Null,
        Values::Number(numbers) => Value::Real(numbers[row]),
        Values::Flag(flags) => flags[row].map_or(Value::Null, |flag| Value::Integer(flag.into())),
        Values::Label(labels) => labels[row].clone().map_or(Value::Null, Value::Text),
    }
}

fn extent(values: &[f64]) -> [f64; 2] {
    let known = || values.iter().copied().filter(|value| !value.is_nan());
    [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)]
}
