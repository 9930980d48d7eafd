//! The sample, with positions.

use std::path::{Path, PathBuf};

use crate::common::of_repository;

/// A recording as text: a header and rows of fields.
#[derive(Clone)]
pub(crate) struct Tow {
    pub(crate) header: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

/// Metres of a degree of latitude, about.
const METRES_A_DEGREE: f64 = 111_200.0;
/// Where it starts, degrees.
pub(crate) const START: [f64; 2] = [54.3, 10.5];
const SPEED_M_PER_S: f64 = 1.5;

impl Tow {
    /// The shipped survey: ten minutes, four legs, with `heading_deg`.
    pub(crate) fn sample() -> Self {
        Self::read(&of_repository("sample/survey.csv"))
    }

    /// Its first half, two legs: where what is found in it does not matter.
    pub(crate) fn beginning() -> Self {
        let mut tow = Self::sample();
        tow.rows.truncate(tow.rows.len() / 2);
        tow
    }

    /// Its first two minutes: where only its files matter.
    pub(crate) fn two_minutes() -> Self {
        let mut tow = Self::sample();
        tow.rows.truncate(1200);
        tow
    }

    /// With the positions of a receiver of 1 Hz on a body that goes where it heads; between them the fields are empty.
    pub(crate) fn with_positions(mut self) -> Self {
        let heading = self.column("heading_deg");
        let (mut north, mut east) = (0.0, 0.0);
        let mut positions: Vec<[String; 2]> = Vec::new();
        for (row, fields) in self.rows.iter().enumerate() {
            let (to_east, to_north) = fields[heading].parse::<f64>().unwrap().to_radians().sin_cos();
            let degrees =
                [START[0] + north / METRES_A_DEGREE, START[1] + east / METRES_A_DEGREE / START[0].to_radians().cos()];
            positions.push(if row % 10 == 0 {
                degrees.map(|degrees| format!("{degrees:.8}"))
            } else {
                Default::default()
            });
            north += 0.1 * SPEED_M_PER_S * to_north;
            east += 0.1 * SPEED_M_PER_S * to_east;
        }
        self = self.with("latitude_deg", |row| positions[row][0].clone());
        self.with("longitude_deg", |row| positions[row][1].clone())
    }

    /// With one column more.
    pub(crate) fn with(mut self, name: &str, value: impl Fn(usize) -> String) -> Self {
        self.header.push(name.into());
        self.rows.iter_mut().enumerate().for_each(|(row, fields)| fields.push(value(row)));
        self
    }

    pub(crate) fn column(&self, name: &str) -> usize {
        self.header.iter().position(|column| column == name).unwrap_or_else(|| panic!("no column {name}"))
    }

    pub(crate) fn read(path: &Path) -> Self {
        let mut reader = csv::Reader::from_path(path).unwrap();
        let header = reader.headers().unwrap().iter().map(String::from).collect();
        let rows = reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect();
        Self { header, rows }
    }

    pub(crate) fn numbers(&self, name: &str) -> Vec<Option<f64>> {
        let column = self.column(name);
        self.rows.iter().map(|fields| fields[column].parse().ok()).collect()
    }

    pub(crate) fn written(&self, folder: &Path, name: &str) -> PathBuf {
        let path = folder.join(name);
        let mut writer = csv::Writer::from_path(&path).unwrap();
        writer.write_record(&self.header).unwrap();
        self.rows.iter().for_each(|fields| writer.write_record(fields).unwrap());
        writer.flush().unwrap();
        path
    }
}
