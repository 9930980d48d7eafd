//! Files of other makers' instruments, in text. They may not be distributed with the project: the tests look for them in
//! `../shared/data` beside the project, or where `TOWMAG_DATA` points, and say that they skip when they are not there.
use std::path::{Path, PathBuf};

use towmag_import::formats::{FORMATS, Input, SourceFormat};
use towmag_import::source::{Clock, FindingKind, SourceColumn, SourceTable, Values};

fn file(name: &str) -> Option<Vec<u8>> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let path = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join("foreign").join(name);
    let bytes = std::fs::read(&path).ok();
    if bytes.is_none() {
        println!("skipped: no {name} beside the project, and TOWMAG_DATA is not set");
    }
    bytes
}

fn format(bytes: &[u8]) -> Option<&'static dyn SourceFormat> {
    FORMATS.iter().copied().find(|format| format.recognises(&bytes[..bytes.len().min(65_536)]))
}

fn read(name: &str, companion: Option<(&str, Vec<u8>)>) -> Option<(&'static str, SourceTable)> {
    let bytes = file(name)?;
    let companions: Vec<_> = companion.map(|(name, bytes)| (name.to_string(), bytes)).into_iter().collect();
    let input = Input { file: name, bytes: &bytes, companions: &companions, part: None };
    let mut source = format(&bytes).unwrap().read(&input).unwrap();
    assert_eq!(source.tables.len(), 1);
    let table = source.tables.remove(0);
    assert!(table.columns.iter().all(|column| column.values.len() == table.rows) && table.places.len() == table.rows);
    Some((source.format, table))
}

fn column<'a>(table: &'a SourceTable, name: &str) -> &'a SourceColumn {
    table.columns.iter().find(|column| column.name == name).unwrap()
}

fn numbers<'a>(table: &'a SourceTable, name: &str) -> &'a [f64] {
    column(table, name).as_numbers().unwrap()
}

fn times(table: &SourceTable) -> &[f64] {
    let Values::Times(times) = &column(table, "time").values else { panic!("{:?}", column(table, "time")) };
    times
}

#[test]
fn an_observatory_has_all_components() {
    let Some((format, table)) = read("iaga2002/bou20141101vmin.min", None) else { return };
    assert_eq!((format, table.rows), ("IAGA-2002", 1440));
    assert_eq!(times(&table)[..2], [1_414_800_000.0, 1_414_800_060.0]);
    assert_eq!(
        [numbers(&table, "H")[0], numbers(&table, "D")[0], numbers(&table, "F")[1439]],
        [20873.75, -9.99, 52390.85]
    );
    assert_eq!(column(&table, "D").unit.as_deref(), Some("arcmin"));
    let (lat, lon) = table.facts.position_deg.unwrap();
    assert!(lat == 40.137 && (lon + 105.236).abs() < 1e-9);
    assert_eq!((table.facts.instrument.as_deref(), &table.notes[..]), (Some("Boulder"), &[][..]));
}

#[test]
fn variometers_have_no_scalar() {
    let Some((_, table)) = read("iaga2002/wic20220810vsec_first3000.sec", None) else { return };
    let lines = file("iaga2002/wic20220810vsec_first3000.sec").unwrap().iter().filter(|byte| **byte == b'\n').count();
    assert_eq!((table.rows, table.facts.position_deg), (lines - 18, None));
    assert!(numbers(&table, "F").iter().all(|value| value.is_nan()));
    assert_eq!(numbers(&table, "X")[0], 20967.20);
    assert_eq!(table.facts.instrument.as_deref(), Some("Conrad Observatory"));
    assert!(table.notes.iter().all(|note| note.kind == FindingKind::Missing), "{:?}", table.notes);
    assert_eq!(table.notes.len(), 2);
    let Some((_, table)) = read("iaga2002/LLO20200106vsec.sec", None) else { return };
    let names: Vec<_> = table.columns.iter().map(|column| &column.name[..]).collect();
    assert_eq!((names, table.rows), (vec!["time", "U", "V", "W", "NUL"], 4 * 3600 + 1));
    assert_eq!(table.facts.instrument.as_deref(), Some("LLO"));
}

#[test]
fn airborne_records_have_all_their_columns() {
    let companion = file("tempest_aseg_gdf2/Tempest.dat").map(|bytes| ("Tempest.dat", bytes));
    let Some((format, table)) = read("tempest_aseg_gdf2/Tempest.dfn", companion) else { return };
    assert_eq!((format, table.rows, table.columns.len()), ("ASEG-GDF2", 2001, 117));
    assert_eq!((table.places[0], table.places[2000], table.notes.len()), (1, 2001, 0));
    assert_eq!([numbers(&table, "TMI")[0], numbers(&table, "Latitude")[1]], [49231.174, 33.8967099]);
    assert_eq!([numbers(&table, "EMX_NonHPRG_1")[0], numbers(&table, "EMZ_HPRG_15")[0]], [4.336857, 0.043866]);
    assert_eq!(numbers(&table, "Z_Geofact")[0], 0.99689);
    assert_eq!(column(&table, "TMI").unit.as_deref(), Some("nT"));
    assert_eq!(column(&table, "TMI").dummy, Some(-99999.999));
    assert!(table.columns.iter().all(|column| column.as_numbers().is_some()));
}

#[test]
fn positions_in_gps_time_are_given_in_utc() {
    let Some((format, table)) = read("rtklib_pos/ValidEmlidGpst.pos", None) else { return };
    assert_eq!((format, table.rows, table.facts.clock), ("RTKLIB positions", 9, Clock::Utc));
    assert!((times(&table)[0] - (1_687_638_152.402)).abs() < 1e-6);
    assert_eq!([numbers(&table, "latitude")[0], numbers(&table, "longitude")[8]], [61.078688979, -139.139210865]);
    assert_eq!(table.notes[0].text, "times are GPS time, 18 s ahead of UTC: given in UTC");
}

#[test]
fn an_autopilots_log_is_named() {
    let Some(bytes) = file("ulog/sample_log_small.ulg") else { return };
    let input = Input { file: "a.ulg", bytes: &bytes, companions: &[], part: None };
    let refusal = format(&bytes).unwrap().read(&input).unwrap_err().to_string();
    assert!(refusal.starts_with("a.ulg: a file of the kind PX4 ULog") && refusal.contains("ulog2csv"), "{refusal}");
}

/// Delimited text is what no format here recognises.
#[test]
fn delimited_text_is_no_format() {
    let names = [
        "magarrow/MagArrow.csv",
        "magdrone/Magdrone.csv",
        "wisconsin_csv/WI_Magnetics.csv",
        "ubc_obs/DO27_TMI.dat",
        "tempest_aseg_gdf2/Tempest.dat",
    ];
    for (name, bytes) in names.iter().filter_map(|name| Some((name, file(name)?))) {
        assert!(format(&bytes).is_none(), "{name}: {:?}", format(&bytes).map(SourceFormat::name));
    }
}
