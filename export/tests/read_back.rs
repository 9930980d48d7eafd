//! Every format, read back by what is not the code that wrote it, value by value. Parquet and MCAP have no other reader in
//! Rust that is light and kept: these are read by their own crates here, and by other programs in `readers.py`.
#![cfg(not(target_os = "none"))]

#[path = "read_back/geojson.rs"]
mod geojson;
#[path = "read_back/gpkg.rs"]
mod gpkg;
#[path = "read_back/hdf5.rs"]
mod hdf5;
#[path = "read_back/layout.rs"]
mod layout;
#[path = "read_back/mcap.rs"]
mod mcap;
#[path = "read_back/parquet.rs"]
mod parquet;
#[path = "read_back/readers.rs"]
mod readers;
#[path = "read_back/xyz.rs"]
mod xyz;

use towmag_export::{Format, Options, Table, encode, read_from};

/// What makes trouble: missing values of each kind, labels with blanks, quotes and other letters, lines without number and
/// without label, a row without position, one over the meridian, one that is marked and holds rubbish, columns of others.
const SAMPLE: &str = "\
time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,scalar_valid,depth_m,latitude_deg,longitude_deg,line,utc_s,\
current_strobe_A,compensated_nT,adaptation,note,count\n\
10.0,49999.123,100.5,-200.25,-48000.125,1,12.5,-33.5,179.9998,101,1700000000.0,0.5,49990.5,learning,\"a \"\"b\"\" é\",1\n\
10.1,49999.223,100.6,-200.35,-48000.225,1,12.6,-33.4,179.9999,101,1700000000.1,,49990.25,learning,,2\n\
10.2,49999.323,100.7,-200.45,-48000.325,1,,-33.3,-179.9999,101,,0.7,,resting,c,\n\
10.3,rubbish,100.8,-200.55,-48000.425,0,12.8,,,,1700000000.3,0.8,49990.125,,d e,4\n\
10.4,49999.523,,-200.65,-48000.525,,12.9,-33.1,-179.9997,box 2,1700000000.4,0.9,49990.0625,relearning,e,-5e-3\n\
10.5,49999.623,101.0,-200.75,-48000.625,1,13.0,-33.0,-179.9996,box 2,1700000000.5,1.0,49990.03125,resting,f,6\n\
10.6,49999.723,101.1,-200.85,-48000.725,1,13.1,-32.9,-179.9995,102,1700000000.6,1.1,49990.015625,resting,g,7\n";

fn sample() -> Table {
    read_from("folder/sample.csv", SAMPLE.as_bytes()).unwrap()
}

fn encoded(format: Format) -> Vec<u8> {
    encode(&sample(), format, &Options::default()).unwrap()
}

/// The sample as text: the header, and the rows, read by the `csv` crate alone.
fn cells() -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_reader(SAMPLE.as_bytes());
    let header = reader.headers().unwrap().iter().map(String::from).collect();
    let row = |row: csv::Result<csv::StringRecord>| row.unwrap().iter().map(String::from).collect();
    (header, reader.records().map(row).collect())
}

/// The field as it is expected: what was marked as rubbish is missing.
fn expected_number(field: &str) -> Option<f64> {
    if field.is_empty() || field == "rubbish" { None } else { Some(field.parse().unwrap()) }
}

const LABELS: [&str; 3] = ["line", "adaptation", "note"];
const FLAGS: [&str; 1] = ["scalar_valid"];

#[test]
fn a_track_needs_positions() {
    let table = read_from("rec.csv", b"time_s,longitude_deg\n0.1,5\n".as_slice()).unwrap();
    for format in [Format::Geojson, Format::Gpkg] {
        let error = encode(&table, format, &Options::default()).unwrap_err();
        assert!(error.is_bad_input());
        assert!(error.to_string().starts_with("rec.csv: latitude_deg is missing, so there is no track"), "{error}");
    }
}

#[test]
fn a_position_is_on_earth() {
    let table = read_from("rec.csv", b"time_s,latitude_deg,longitude_deg\n0.1,5,6\n0.2,91,6\n".as_slice()).unwrap();
    for format in [Format::Geojson, Format::Gpkg, Format::Mcap] {
        let error = encode(&table, format, &Options::default()).unwrap_err().to_string();
        assert_eq!(error, "rec.csv:3: latitude_deg: 91 is outside -90 to 90 degrees");
    }
}
