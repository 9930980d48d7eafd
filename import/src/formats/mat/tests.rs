//! Against files that scipy wrote.

use super::*;

fn read(bytes: &[u8], part: Option<&str>) -> Result<Source, ImportError> {
    assert!(Mat.recognises(bytes));
    Mat.read(&Input { file: "f.mat", bytes, companions: &[], part })
}

fn column<'a>(table: &'a SourceTable, name: &str) -> &'a [f64] {
    let column = table.columns.iter().find(|column| column.name == name);
    column.and_then(|column| column.as_numbers()).unwrap_or_else(|| panic!("no column {name}"))
}

#[test]
fn structs_and_flat_files_and_both_ways_of_lying_give_the_same() {
    let [of_struct, flat, plain] = [
        &include_bytes!("../../../tests/corpus/mat_struct.mat")[..],
        include_bytes!("../../../tests/corpus/mat_flat.mat"),
        include_bytes!("../../../tests/corpus/mat_plain.mat"),
    ]
    .map(|bytes| read(bytes, None).unwrap().tables.remove(0));
    assert_eq!((of_struct.name.as_str(), flat.name.as_str(), of_struct.rows), ("xyz", "", 150));
    assert_eq!(of_struct.facts.rate_hz, Some(10.0));
    assert_eq!(flat.facts.rate_hz, Some(10.0));
    for name in ["tt", "mag_1_uc", "flux_a_x", "flux_a_z", "depth", "line"] {
        assert_eq!(column(&of_struct, name), column(&flat, name), "{name}");
        assert_eq!(column(&plain, name), column(&flat, name), "{name}");
    }
    assert_eq!(column(&plain, "tt")[..2], [86390.0, 86390.1]);
    assert_eq!(column(&plain, "line")[0], 101.0);
    let unit = |name: &str| flat.columns.iter().find(|column| column.name == name).and_then(|c| c.unit.as_deref());
    assert_eq!([unit("mag_1_uc"), unit("flux_a_y"), unit("lat")], [Some("nT"), Some("nT"), Some("deg")]);
}

#[test]
fn structs_within_a_struct_give_the_names_of_magnav_and_an_array_its_columns() {
    let source = read(include_bytes!("../../../tests/corpus/mat_nested.mat"), None).unwrap();
    let table = &source.tables[0];
    assert_eq!(table.notes[0].text, "took \"xyz\" of \"\", \"xyz\"");
    assert_eq!((table.rows, table.facts.rate_hz), (30, Some(10.0)));
    assert_eq!(column(table, "tt")[1], 86390.1);
    assert_eq!(column(table, "flux_a_x").len(), 30);
    assert!(
        column(table, "ins_lat")
            .iter()
            .zip(column(table, "lat"))
            .all(|(ins, lat)| (ins.to_degrees() - lat).abs() < 1e-9)
    );
    let crate::source::Values::Text(texts) = &table.columns.last().unwrap().values else { panic!("no texts") };
    assert_eq!((&*texts[0], &*texts[29]), ("leg", "turn"));
    let other = read(include_bytes!("../../../tests/corpus/mat_nested.mat"), Some("")).unwrap();
    assert_eq!(column(&other.tables[0], "matrix_2")[1..3], [4.0, 7.0]);
}

#[test]
fn a_cut_file_is_refused() {
    let refusal = read(include_bytes!("../../../tests/corpus/mat_cut.mat"), None).unwrap_err().to_string();
    assert!(refusal.contains("cut or damaged"), "{refusal}");
    assert!(read(include_bytes!("../../../tests/corpus/damaged_mat_struct.mat"), None).is_err());
    let whole = include_bytes!("../../../tests/corpus/mat_plain.mat");
    let refusal = read(&whole[..1000], None).unwrap_err().to_string();
    assert!(refusal.contains("cut or damaged"), "{refusal}");
}

#[test]
fn another_struct_than_those_there_is_refused() {
    let refusal = read(include_bytes!("../../../tests/corpus/mat_struct.mat"), Some("abc")).unwrap_err().to_string();
    assert_eq!(refusal, "f.mat: has no part \"abc\"; it has \"xyz\"");
}

/// An element with its length and filling, in big-endian order.
fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut element = [kind.to_be_bytes(), (bytes.len() as u32).to_be_bytes()].concat();
    element.extend(bytes);
    element.resize(element.len().next_multiple_of(8), 0);
    element
}

#[test]
fn a_file_of_the_other_order_of_bytes_is_read() {
    let numbers: Vec<u8> = [1.5_f64, -2.0, f64::NAN].iter().flat_map(|number| number.to_be_bytes()).collect();
    let sizes: Vec<u8> = [3_i32, 1].iter().flat_map(|size| size.to_be_bytes()).collect();
    let parts = [element(6, &[0, 0, 0, 6, 0, 0, 0, 0]), element(5, &sizes), element(1, b"tt"), element(9, &numbers)];
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([1, 0, b'M', b'I']);
    file.extend(element(14, &parts.concat()));
    let table = read(&file, None).unwrap().tables.remove(0);
    let values = column(&table, "tt");
    assert_eq!(values[..2], [1.5, -2.0]);
    assert!(values[2].is_nan());
}
