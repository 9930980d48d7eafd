//! The shipped recordings, read by the `csv` crate alone: what tests of the core are built with does not include host-sim.

use std::path::Path;
use towmag::{Epoch, RATE_HZ};

/// Every row of a recording in `sample/`, none of which lacks a value.
pub(crate) fn epochs(name: &str) -> Vec<Epoch> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample").join(name);
    let mut recording = csv::Reader::from_path(path).unwrap();
    let columns = ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];
    let header = recording.headers().unwrap().clone();
    let places = columns.map(|name| header.iter().position(|column| column == name).unwrap());
    let number = |row: &csv::StringRecord, place: usize| row[places[place]].parse::<f64>().unwrap();
    let epoch = |row: csv::StringRecord| Epoch {
        tick: (number(&row, 0) * RATE_HZ).round() as u32,
        scalar_pt: Some((number(&row, 1) * 1e3).round() as i32),
        flux_nt: Some([2, 3, 4].map(|place| number(&row, place) as f32)),
    };
    recording.records().map(|row| epoch(row.unwrap())).collect()
}
