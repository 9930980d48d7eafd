//! Parquet, read by its crate; `readers.py` reads it by another one.

use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::Field;
use bytes::Bytes;
use towmag_export::{Format, Options, encode, read_from};

use super::{FLAGS, LABELS, cells, encoded};

#[test]
fn columns_are_as_they_were() {
    let reader = SerializedFileReader::new(Bytes::from(encoded(Format::Parquet))).unwrap();
    let (header, rows) = cells();
    let found: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(found.len(), rows.len());
    for (found, row) in found.iter().zip(&rows) {
        for ((name, field), (expected_name, text)) in found.get_column_iter().zip(header.iter().zip(row)) {
            assert_eq!(name, expected_name);
            let expected = match name.as_str() {
                _ if text.is_empty() || text == "rubbish" => Field::Null,
                name if LABELS.contains(&name) => Field::Str(text.clone()),
                name if FLAGS.contains(&name) => Field::Bool(text == "1"),
                _ => Field::Double(text.parse().unwrap()),
            };
            assert_eq!(*field, expected, "{name}");
        }
        assert_eq!(found.len(), header.len());
    }
}

#[test]
fn units_are_in_the_metadata() {
    let reader = SerializedFileReader::new(Bytes::from(encoded(Format::Parquet))).unwrap();
    let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
    let value = |key: &str| metadata.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.as_deref());
    assert_eq!((value("unit:scalar_nT"), value("unit:current_strobe_A")), (Some("nT"), Some("A")));
    assert_eq!((value("unit:note"), value("source")), (None, Some("sample.csv")));
}

#[test]
fn a_long_table_has_several_groups_and_every_row() {
    let rows = (1 << 17) + 10;
    let text: String = (0..rows).map(|row| format!("{},{}\n", f64::from(row) / 10.0, row % 3)).collect();
    let table = read_from("long.csv", format!("time_s,count\n{text}").as_bytes()).unwrap();
    let bytes = encode(&table, Format::Parquet, &Options::default()).unwrap();
    let reader = SerializedFileReader::new(Bytes::from(bytes)).unwrap();
    assert_eq!(reader.num_row_groups(), 2);
    let second = reader.get_row_group(1).unwrap();
    let found: Vec<_> = second.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(found.len(), 10);
    for (row, found) in (1 << 17..).zip(found) {
        let expected = [Field::Double(f64::from(row) / 10.0), Field::Double(f64::from(row % 3))];
        assert!(found.get_column_iter().map(|(_, field)| field).eq(&expected), "{row}");
    }
}
