//! Against files that h5py wrote.

use std::io::Read as _;

use super::*;

macro_rules! corpus {
    ($name:literal) => {
        include_bytes!(concat!("../../../tests/corpus/", $name)).as_slice()
    };
}

fn read(bytes: &[u8], part: Option<&str>) -> Result<Source, ImportError> {
    assert!(MagNavHdf5.recognises(bytes));
    MagNavHdf5.read(&Input { file: "f.h5", bytes, companions: &[], part })
}

fn table_of(bytes: &[u8]) -> SourceTable {
    read(bytes, None).unwrap().tables.remove(0)
}

fn column<'a>(table: &'a SourceTable, name: &str) -> &'a SourceColumn {
    table.columns.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("no column {name}"))
}

fn numbers<'a>(table: &'a SourceTable, name: &str) -> &'a [f64] {
    column(table, name).as_numbers().unwrap()
}

/// A column of the truth.
fn truth(name: &str) -> Vec<f64> {
    let mut lines = csv::Reader::from_reader(corpus!("truth.csv"));
    let index = lines.headers().unwrap().iter().position(|header| header == name).unwrap();
    lines.records().map(|line| line.unwrap()[index].parse().unwrap()).collect()
}

fn assert_is_truth(table: &SourceTable, first: usize, tolerance: f64) {
    let fields =
        [("mag_1_uc", "scalar_nT"), ("flux_a_x", "flux_x_nT"), ("flux_a_z", "flux_z_nT"), ("lat", "latitude_deg")];
    for (ours, theirs) in fields {
        for (index, (a, b)) in numbers(table, ours).iter().zip(&truth(theirs)[first..]).enumerate() {
            assert!((a - b).abs() <= tolerance || a.is_nan(), "{ours} row {index}: {a} is not {b}");
        }
    }
}

#[test]
fn every_way_to_store_them_gives_the_same_numbers() {
    let files = [corpus!("magnav_deflate.h5"), corpus!("magnav_2021.h5"), corpus!("magnav_1_14.h5")];
    for (file, rows) in files.into_iter().zip([100, 60, 150]) {
        let table = table_of(file);
        assert_eq!((table.rows, table.facts.rate_hz, table.name.as_str()), (rows, Some(10.0), ""));
        assert!(table.columns.iter().all(|column| column.values.len() == rows));
        assert_is_truth(&table, 0, 1e-9);
    }
    assert_is_truth(&table_of(corpus!("magnav_f32.h5")), 0, 0.004);
}

#[test]
fn the_fields_of_2020_have_their_units() {
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(corpus!("magnav_2020.h5.gz")).read_to_end(&mut bytes).unwrap();
    let table = table_of(&bytes);
    let unit = |name: &str| column(&table, name).unit.clone().unwrap_or_default();
    let names = ["tt", "lat", "ins_lat", "mag_6_uc", "flux_d_y", "diurnal", "cur_tank", "vol_bat", "ins_yaw", "doy"];
    assert_eq!(names.map(unit), ["s", "deg", "rad", "nT", "nT", "nT", "A", "V", "deg", ""]);
    assert_is_truth(&table, 0, 1e-9);
}

#[test]
fn of_groups_the_first_is_taken_and_another_where_it_is_asked_for() {
    let first = table_of(corpus!("magnav_groups.h5"));
    assert_eq!(first.name, "flt1002");
    assert_eq!(first.notes[0].text, "took \"flt1002\" of \"flt1002\", \"flt1003\"");
    assert_is_truth(&first, 0, 1e-9);
    let second = read(corpus!("magnav_groups.h5"), Some("flt1003")).unwrap().tables.remove(0);
    assert!(second.notes.is_empty());
    assert_is_truth(&second, 100, 1e-9);
    let refusal = read(corpus!("magnav_groups.h5"), Some("x")).unwrap_err().to_string();
    assert_eq!(refusal, "f.h5: has no part \"x\"; it has \"flt1002\", \"flt1003\"");
}

#[test]
fn integers_and_texts_are_columns_and_a_picture_is_left_out_aloud() {
    let table = table_of(corpus!("magnav_mixed.h5"));
    assert_eq!(numbers(&table, "line")[..2], [101.0, 101.0]);
    assert_eq!(numbers(&table, "mark")[99], 99.0);
    assert_eq!(numbers(&table, "flag")[..3], [1.0, 0.0, 1.0]);
    for (name, expected) in [("note", "row 2"), ("remark", "r2")] {
        let Values::Text(texts) = &column(&table, name).values else { panic!("{name} is no text") };
        assert_eq!(&*texts[2], expected);
    }
    assert!(numbers(&table, "mag_1_uc")[10].is_nan());
    assert_is_truth(&table, 0, 1e-9);
    assert!(table.notes[0].text.ends_with("picture"), "{:?}", table.notes);
}

#[test]
fn matlab_7_3_is_read_behind_its_header() {
    let source = read(corpus!("mat_73.mat"), None).unwrap();
    assert_eq!(source.format, "MATLAB 7.3");
    let table = &source.tables[0];
    assert_eq!(table.rows, 150);
    assert_eq!(numbers(table, "mag_1_uc"), &truth("scalar_nT")[..150]);
}

#[test]
fn a_cut_file_is_refused() {
    let refusal = read(corpus!("magnav_cut.h5"), None).unwrap_err().to_string();
    assert!(refusal.contains("cut or damaged"), "{refusal}");
    assert!(
        MagNavHdf5
            .read(&Input { file: "f.h5", bytes: corpus!("damaged_magnav_f32.h5"), companions: &[], part: None })
            .is_err()
    );
}

#[test]
fn what_a_dataset_claims_is_held_against_the_file_before_it_is_made() {
    let mut builder = hdf5_pure::FileBuilder::new();
    builder.create_dataset("tt").with_f64_data(&[0.0, 0.1, 0.2]).with_shape(&[3]);
    let honest = builder.finish().unwrap();
    let place = honest.windows(8).position(|bytes| bytes == 3_u64.to_le_bytes()).unwrap();
    let mut claim = honest.clone();
    claim[place..place + 8].copy_from_slice(&300_000_000_000_u64.to_le_bytes());
    assert_eq!(table_of(&honest).rows, 3);
    assert!(read(&claim, None).is_err());
}

#[test]
fn a_chunk_that_is_larger_than_its_dataset_is_held_against_the_file_too() {
    let file = |chunk: u64| {
        let mut builder = hdf5_pure::FileBuilder::new();
        let rows = builder.create_dataset("tt").with_f64_data(&[0.0, 0.1, 0.2]).with_shape(&[3]);
        rows.with_maxshape(&[hdf5_pure::MaxExtent::Unlimited]).with_chunks(&[chunk]).with_deflate(6);
        builder.finish().unwrap()
    };
    assert_eq!(table_of(&file(100)).rows, 3);
    let refusal = read(&file(3_000_000), None).unwrap_err().to_string();
    assert!(refusal.contains("larger than"), "{refusal}");
}
