//! GeoPackage, read as what it is, an SQLite file, with its geometries as the `wkb` crate reads them.

use geo_traits::{CoordTrait, GeometryTrait, GeometryType, LineStringTrait, PointTrait};
use rusqlite::types::Value;
use rusqlite::{Connection, MAIN_DB};
use towmag_export::{Format, Options, encode, read_from};

use super::{FLAGS, LABELS, cells, encoded, expected_number};

fn open(bytes: &[u8]) -> Connection {
    let mut database = Connection::open_in_memory().unwrap();
    database.deserialize_read_exact(MAIN_DB, bytes, bytes.len(), true).unwrap();
    database
}

/// Behind the eight bytes of the GeoPackage's own header.
fn places(blob: &[u8], srs_id: i32) -> Vec<[f64; 2]> {
    assert_eq!((&blob[..4], &blob[4..8]), (b"GP\0\x01".as_slice(), srs_id.to_le_bytes().as_slice()));
    let geometry = wkb::reader::read_wkb(&blob[8..]).unwrap();
    match geometry.as_type() {
        GeometryType::Point(point) => vec![point.coord().map(|place| [place.x(), place.y()]).unwrap()],
        GeometryType::LineString(line) => line.coords().map(|place| [place.x(), place.y()]).collect(),
        _ => panic!("neither point nor line"),
    }
}

#[test]
fn samples_have_all_columns() {
    let database = open(&encoded(Format::Gpkg));
    let (header, rows) = cells();
    let mut query = database.prepare("SELECT * FROM samples ORDER BY fid").unwrap();
    let expected = ["fid", "geom"].into_iter().chain(header.iter().map(String::as_str));
    assert!(query.column_names().eq(expected));
    let mut read = query.query([]).unwrap();
    for row in &rows {
        let found = read.next().unwrap().unwrap();
        let place = |name: &str| expected_number(&row[header.iter().position(|other| other == name).unwrap()]);
        let expected = place("longitude_deg").zip(place("latitude_deg")).map(|(x, y)| vec![[x, y]]);
        let blob: Option<Vec<u8>> = found.get(1).unwrap();
        assert_eq!(blob.map(|blob| places(&blob, 4326)), expected);
        for (at, (name, field)) in header.iter().zip(row).enumerate() {
            let expected = match name.as_str() {
                _ if field.is_empty() || field == "rubbish" => Value::Null,
                name if LABELS.contains(&name) => Value::Text(field.clone()),
                name if FLAGS.contains(&name) => Value::Integer(field.parse().unwrap()),
                _ => Value::Real(field.parse().unwrap()),
            };
            assert_eq!(found.get::<_, Value>(at + 2).unwrap(), expected, "{name}");
        }
    }
    assert!(read.next().unwrap().is_none());
}

#[test]
fn the_track_has_a_line_a_leg() {
    let database = open(&encoded(Format::Gpkg));
    let mut query = database.prepare("SELECT geom, line, start_time_s, end_time_s, end_utc_s, n FROM track").unwrap();
    type Leg = (Option<Vec<u8>>, Option<String>, f64, f64, f64, u32);
    let row = |row: &rusqlite::Row<'_>| -> rusqlite::Result<Leg> {
        Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?, row.get(5)?))
    };
    let legs: Vec<Leg> = query.query_map([], row).unwrap().map(Result::unwrap).collect();
    let facts: Vec<_> = legs.iter().map(|leg| (leg.1.as_deref(), leg.2, leg.3, leg.4, leg.5)).collect();
    assert_eq!(
        facts,
        [
            (Some("101"), 10.0, 10.2, 1700000000.1, 3),
            (None, 10.3, 10.3, 1700000000.3, 1),
            (Some("box 2"), 10.4, 10.5, 1700000000.5, 2),
            (Some("102"), 10.6, 10.6, 1700000000.6, 1)
        ]
    );
    let lines: Vec<_> = legs.iter().map(|leg| leg.0.as_ref().map(|blob| places(blob, 4326))).collect();
    assert_eq!(lines[0].as_ref().unwrap()[..], [[179.9998, -33.5], [179.9999, -33.4], [-179.9999, -33.3]]);
    assert_eq!(lines[2].as_ref().unwrap()[..], [[-179.9997, -33.1], [-179.9996, -33.0]]);
    assert_eq!((&lines[1], &lines[3]), (&None, &None));
}

#[test]
fn it_says_that_it_is_one() {
    let database = open(&encoded(Format::Gpkg));
    let pragma = |name: &str| database.query_row(&format!("PRAGMA {name}"), [], |row| row.get::<_, i64>(0)).unwrap();
    assert_eq!((pragma("application_id"), pragma("user_version")), (0x4750_4B47, 10300));
    let check: String = database.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
    assert_eq!(check, "ok");
    let broken = database.prepare("PRAGMA foreign_key_check").unwrap().query([]).unwrap().next().unwrap().is_some();
    assert!(!broken);
    let extent = "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'samples'";
    let row = |row: &rusqlite::Row<'_>| -> rusqlite::Result<[f64; 4]> {
        Ok([row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?])
    };
    assert_eq!(database.query_row(extent, [], row).unwrap(), [-179.9999, -33.5, 179.9999, -32.9]);
    let columns = "SELECT table_name || column_name || geometry_type_name || srs_id FROM gpkg_geometry_columns";
    let mut query = database.prepare(columns).unwrap();
    let found: Vec<String> = query.query_map([], |row| row.get(0)).unwrap().map(Result::unwrap).collect();
    assert_eq!(found, ["samplesgeomPOINT4326", "trackgeomLINESTRING4326"]);
}

#[test]
fn names_that_sql_would_mix_up_stay_apart() {
    let csv = "time_s,fid,geom,a\"b,Note,note,easting_m,northing_m\n0.1,7,8,9,x,y,500000,6300000\n";
    let table = read_from("g.csv", csv.as_bytes()).unwrap();
    let database = open(&encode(&table, Format::Gpkg, &Options::default()).unwrap());
    let query = database.prepare("SELECT * FROM samples").unwrap();
    let names = ["fid_", "geom_", "time_s", "fid", "geom", "a\"b", "Note", "note_", "easting_m", "northing_m"];
    assert_eq!(query.column_names().collect::<Vec<_>>(), names);
    let found = database.query_row("SELECT geom_, fid, note_, \"a\"\"b\" FROM samples", [], |row| {
        Ok((row.get::<_, Vec<u8>>(0)?, row.get::<_, f64>(1)?, row.get::<_, String>(2)?, row.get::<_, f64>(3)?))
    });
    let (blob, fid, note, quoted) = found.unwrap();
    assert_eq!((places(&blob, -1), fid, note.as_str(), quoted), (vec![[500000.0, 6300000.0]], 7.0, "y", 9.0));
    let column: String =
        database.query_row("SELECT column_name FROM gpkg_geometry_columns LIMIT 1", [], |row| row.get(0)).unwrap();
    assert_eq!(column, "geom_");
}
