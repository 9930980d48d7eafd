//! HDF5, read by another crate than the one that writes.

use hdf5_reader::Hdf5File;
use towmag_export::Format;

use super::{FLAGS, LABELS, cells, encoded, expected_number};

fn numbers(file: &Hdf5File, name: &str) -> Vec<f64> {
    file.dataset(name).unwrap().read_array::<f64>().unwrap().iter().copied().collect()
}

#[test]
fn data_sets_have_the_names_of_magnav() {
    let theirs = [
        ("time_s", "tt"),
        ("scalar_nT", "mag_1_uc"),
        ("flux_x_nT", "flux_a_x"),
        ("flux_y_nT", "flux_a_y"),
        ("flux_z_nT", "flux_a_z"),
        ("latitude_deg", "lat"),
        ("longitude_deg", "lon"),
        ("compensated_nT", "mag_1_c"),
    ];
    let file = Hdf5File::from_vec(encoded(Format::Hdf5)).unwrap();
    let (header, rows) = cells();
    for (at, ours) in header.iter().enumerate().filter(|(_, ours)| *ours != "line") {
        let name = theirs.iter().find(|(name, _)| name == ours).map_or(ours.as_str(), |(_, theirs)| theirs);
        if LABELS.contains(&ours.as_str()) {
            let expected: Vec<&str> = rows.iter().map(|row| row[at].as_str()).collect();
            assert_eq!(file.dataset(name).unwrap().read_strings().unwrap(), expected, "{name}");
            continue;
        }
        let found = numbers(&file, name);
        assert_eq!(found.len(), rows.len());
        for (found, row) in found.iter().zip(&rows) {
            assert_eq!(Some(*found).filter(|found| !found.is_nan()), expected_number(&row[at]), "{name}");
        }
    }
    assert!(header.iter().any(|name| FLAGS.contains(&name.as_str())));
}

#[test]
fn what_magnav_wants_beside_the_columns_is_there() {
    let file = Hdf5File::from_vec(encoded(Format::Hdf5)).unwrap();
    for (name, value) in [("dt", 0.1), ("N", 7.0)] {
        assert_eq!(file.dataset(name).unwrap().shape(), [0_u64; 0]);
        assert_eq!(numbers(&file, name), [value]);
    }
    assert_eq!(numbers(&file, "line"), [101.0, 101.0, 101.0, 1.0, 2.0, 2.0, 102.0]);
    let labels = file.dataset("line_label").unwrap().read_strings().unwrap();
    assert_eq!(labels, ["101", "101", "101", "", "box 2", "box 2", "102"]);
    let altitude_m = numbers(&file, "alt");
    assert!(altitude_m[2].is_nan());
    assert_eq!((altitude_m[0], altitude_m[6]), (-12.5, -13.1));
    let unit = file.dataset("mag_1_uc").unwrap().attribute("unit").unwrap().read_string().unwrap();
    assert_eq!(unit, "nT");
}
