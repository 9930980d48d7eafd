//! Recordings in memory, to be damaged.

use std::path::{Path, PathBuf};

use towmag_import::{File, Input, Options, Recording, import};

use crate::common::of_repository;

/// A recording as text and numbers.
#[derive(Clone)]
pub(crate) struct Copy {
    pub(crate) name: String,
    pub(crate) columns: Vec<(String, Vec<f64>)>,
}

impl Copy {
    /// Columns of numbers; text becomes nothing.
    pub(crate) fn read(name: &str, csv: &[u8]) -> Self {
        let mut reader = csv::Reader::from_reader(csv);
        let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_string).collect();
        let mut columns: Vec<(String, Vec<f64>)> = names.into_iter().map(|name| (name, Vec::new())).collect();
        for record in reader.records() {
            for ((_, column), field) in columns.iter_mut().zip(record.unwrap().iter()) {
                column.push(field.parse().unwrap_or(f64::NAN));
            }
        }
        columns.retain(|(_, column)| column.iter().any(|value| value.is_finite()));
        Self { name: name.into(), columns }
    }

    pub(crate) fn column(&self, name: &str) -> &[f64] {
        &self.columns.iter().find(|(there, _)| there == name).unwrap_or_else(|| panic!("{name}")).1
    }

    pub(crate) fn column_mut(&mut self, name: &str) -> &mut Vec<f64> {
        &mut self.columns.iter_mut().find(|(there, _)| there == name).unwrap().1
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|(there, _)| there == name)
    }

    pub(crate) fn csv(&self) -> Vec<u8> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|(name, _)| name)).unwrap();
        for row in 0..self.columns[0].1.len() {
            let value = |value: f64| if value.is_finite() { format!("{value}") } else { String::new() };
            writer.write_record(self.columns.iter().map(|(_, column)| value(column[row]))).unwrap();
        }
        writer.into_inner().unwrap()
    }

    pub(crate) fn imported(&self, options: &Options) -> Recording {
        let file = Input::File(File { name: self.name.clone(), bytes: self.csv() });
        import(vec![file], options).unwrap_or_else(|error| panic!("{error}"))
    }

    pub(crate) fn imported_csv(&self) -> Vec<u8> {
        let mut csv = Vec::new();
        self.imported(&Options::default()).write_csv(&mut csv).unwrap();
        csv
    }

    pub(crate) fn warnings(&self) -> Vec<String> {
        let findings = self.imported(&Options::default()).report.findings;
        findings.into_iter().filter(|finding| finding.is_warning).map(|finding| finding.text).collect()
    }
}

fn of_file(path: &Path) -> Copy {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    Copy::read(&name, &std::fs::read(path).unwrap())
}

/// Calibration and survey.
pub(crate) fn sample() -> Vec<Copy> {
    ["sample/calibration.csv", "sample/survey.csv"].map(|name| of_file(&of_repository(name))).into()
}

/// The presets, with the columns that tell the attitude and without.
pub(crate) fn scenarios() -> Vec<Copy> {
    let made = |name: &str| {
        let (folder, scenario) = (tempfile::TempDir::new().unwrap(), of_repository("scenarios").join(name));
        let out = folder.path().join("rec.csv");
        host_sim::command::simulate(&scenario, &out, None, &[], None).unwrap();
        Copy::read(name, &std::fs::read(out).unwrap())
    };
    let with: Vec<Copy> = ["lake_tow.toml", "sea_tow.toml", "land_calibration.toml"].map(made).into();
    let bare = |copy: &Copy| {
        let required = ["time_s", "scalar_nT", "flux_x_nT", "flux_y_nT", "flux_z_nT"];
        let columns = copy.columns.iter().filter(|(name, _)| required.contains(&name.as_str())).cloned().collect();
        Copy { name: format!("{} without attitude", copy.name), columns }
    };
    let without: Vec<Copy> = with.iter().map(bare).collect();
    with.into_iter().chain(without).collect()
}

fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from);
    let is_there = folder.is_dir();
    if !is_there {
        println!("skipped: no recordings in {}", folder.display());
    }
    is_there.then_some(folder)
}

/// The eight flights, where they are.
pub(crate) fn flights() -> Vec<Copy> {
    let Some(folder) = data().map(|data| data.join("sgl_line_1002_20")) else { return Vec::new() };
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "csv"));
    paths.sort();
    paths.iter().map(|path| of_file(path)).collect()
}

/// A peer's test data, where it is.
pub(crate) fn peer() -> Option<Copy> {
    let path = data()?.join("peers/magnav_jl_tolles_lawson.csv");
    path.is_file().then(|| of_file(&path))
}
