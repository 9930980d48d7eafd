//! The files of other people's writers in `corpus/`: all imported right, or refused with the cause and the remedy.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use towmag_import::{File, Input, Options, import, profile};

const DAY_S: f64 = 86_400.0;

#[derive(Deserialize)]
struct Manifest {
    file: Vec<Entry>,
}

/// README.md of the corpus says what the keys mean.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    dialect: String,
    expect: String,
    #[serde(default)]
    says: Vec<String>,
    #[serde(default)]
    columns: BTreeMap<String, f64>,
    #[serde(default)]
    findings: Vec<String>,
    rows: Option<usize>,
    #[serde(default)]
    first: usize,
    every: Option<usize>,
    truth: Option<String>,
    #[serde(default)]
    time_offset_s: f64,
    #[serde(default)]
    time_slack_s: f64,
    source_rate_hz: Option<f64>,
    #[serde(default)]
    edge_s: f64,
    #[serde(default)]
    missing: BTreeMap<String, Vec<usize>>,
    #[serde(default)]
    invalid: Vec<usize>,
    #[serde(default)]
    absent: Vec<String>,
    #[serde(default)]
    options: Vec<String>,
    part: Option<String>,
    #[serde(default)]
    companions: Vec<String>,
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

fn file(name: &str) -> Input {
    Input::File(File { name: name.into(), bytes: std::fs::read(corpus().join(name)).unwrap() })
}

fn options(entry: &Entry) -> Options {
    let mut options = Options::default();
    options.profile.part = entry.part.clone();
    for pair in entry.options.chunks(2) {
        let [name, value] = pair else { panic!("{}: options come in pairs", entry.file) };
        match name.as_str() {
            "--axes" => options.profile.axes = Some(profile::parse_axes(value).unwrap()),
            "--rate" => options.profile.time.rate_hz = Some(value.parse().unwrap()),
            "--scalar" => options.scalar = Some(value.clone()),
            "--flux" => options.flux = Some(value.clone()),
            "--units" => options.units = Some(value.clone()),
            "--date" => options.profile.time.date = Some(value.clone()),
            other => panic!("{}: {other}", entry.file),
        }
    }
    options
}

/// Columns of a CSV, NaN where a value is missing.
fn table(csv: &[u8]) -> BTreeMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_reader(csv);
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_string).collect();
    let mut columns: BTreeMap<String, Vec<f64>> = names.iter().map(|name| (name.clone(), Vec::new())).collect();
    for record in reader.records() {
        for (name, field) in names.iter().zip(record.unwrap().iter()) {
            columns.get_mut(name).unwrap().push(field.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

fn truth(name: &str) -> BTreeMap<String, Vec<f64>> {
    let bytes = std::fs::read(corpus().join(name)).unwrap();
    let (bytes, _) = towmag_import::compressed::expand(name, bytes).unwrap();
    table(&bytes)
}

/// What is wrong with the import of an entry.
fn wrong(entry: &Entry) -> Option<String> {
    let files = std::iter::once(&entry.file).chain(&entry.companions).map(|name| file(name)).collect();
    let imported = import(files, &options(entry));
    match (entry.expect.as_str(), imported) {
        ("refused", Err(error)) => {
            let message = error.to_string();
            let lacks = entry.says.iter().find(|word| !message.to_lowercase().contains(&word.to_lowercase()));
            lacks.map(|word| format!("\"{word}\" is not in: {message}"))
        }
        ("refused", Ok(recording)) => Some(format!("was imported: {:?}", recording.report.lines())),
        (_, Err(error)) => Some(format!("was refused: {error}")),
        (_, Ok(recording)) => {
            let mut csv = Vec::new();
            recording.write_csv(&mut csv).unwrap();
            let report = &recording.report;
            compare(entry, &table(&csv), report.source_rate_hz)
                .or_else(|| {
                    let kinds = serde_json::to_string(&report.findings).unwrap();
                    let lacks = entry.findings.iter().find(|kind| !kinds.contains(&format!("\"kind\":\"{kind}\"")));
                    lacks.map(|kind| format!("no finding \"{kind}\""))
                })
                .map(|what| format!("{what}\n      {}", report.lines().join("\n      ")))
        }
    }
}

fn compare(entry: &Entry, made: &BTreeMap<String, Vec<f64>>, rate_hz: f64) -> Option<String> {
    let truth = truth(entry.truth.as_deref().unwrap_or("truth.csv"));
    let every = entry.every.unwrap_or(1);
    let rows = entry.rows.unwrap_or(truth["time_s"].len());
    let time_s = &made["time_s"];
    if (rate_hz - entry.source_rate_hz.unwrap_or(10.0 / every as f64)).abs() > 0.02 * rate_hz {
        return Some(format!("rate is {rate_hz}"));
    }
    if entry.truth.is_none() && time_s.len() != rows {
        return Some(format!("{} rows of {rows}", time_s.len()));
    }
    if let Some(name) = entry.absent.iter().find(|name| made.contains_key(*name)) {
        return Some(format!("{name} is there"));
    }
    let wanted = |at: usize| entry.first + at * every;
    // Where a row of the recording is in the truth: by its time, whatever day it counts from.
    let first_truth = truth["time_s"][wanted(0)] + entry.time_offset_s;
    let mut offset_s = time_s[0] - first_truth;
    offset_s -= (offset_s / DAY_S).round() * DAY_S;
    if offset_s.abs() > entry.time_slack_s + 1e-3 && entry.truth.is_none() {
        return Some(format!("begins {offset_s} s off"));
    }
    let row_of = |at: usize| match &entry.truth {
        None => Some(wanted(at)),
        Some(_) => {
            let since = time_s[at] - time_s[0] + offset_s + truth["time_s"][wanted(0)];
            truth["time_s"].iter().position(|time| (time - since).abs() < 0.02)
        }
    };
    let last_s = time_s[time_s.len() - 1];
    for (name, tolerance) in &entry.columns {
        let Some(column) = made.get(name) else { return Some(format!("{name} is not there")) };
        let mut compared = 0;
        for at in 0..time_s.len() {
            let is_edge = time_s[at] - time_s[0] < entry.edge_s || last_s - time_s[at] < entry.edge_s;
            let is_missing = entry.missing.get(name).is_some_and(|rows| rows.contains(&at));
            let Some(row) = row_of(at).filter(|_| !is_edge && !entry.invalid.contains(&at)) else { continue };
            let right =
                if is_missing { column[at].is_nan() } else { (column[at] - truth[name][row]).abs() <= *tolerance };
            if !right {
                return Some(format!("{name} of row {at} is {} and not {}", column[at], truth[name][row]));
            }
            compared += 1;
        }
        if compared * 3 < time_s.len() {
            return Some(format!("{name}: only {compared} rows were compared"));
        }
    }
    let flags = made.get("scalar_valid");
    let used = entry.invalid.iter().find(|row| {
        let flagged = flags.is_some_and(|flags| flags[**row] == 0.0);
        !flagged && made.get("scalar_nT").is_some_and(|scalar| !scalar[**row].is_nan())
    });
    used.map(|row| format!("row {row} is not invalid"))
}

#[test]
fn all_files_are_imported_right_or_refused_with_cause_and_remedy() {
    let text = std::fs::read_to_string(corpus().join("manifest.toml")).unwrap();
    let manifest: Manifest = toml::from_str(&text).unwrap();
    assert!(manifest.file.len() >= 40);
    let wrong: Vec<String> = manifest
        .file
        .iter()
        .filter_map(|entry| wrong(entry).map(|what| format!("{} ({}): {what}", entry.file, entry.dialect)))
        .collect();
    println!("{} files, {} wrong", manifest.file.len(), wrong.len());
    assert!(wrong.is_empty(), "{} of {} files:\n{}", wrong.len(), manifest.file.len(), wrong.join("\n"));
}

/// What an import has written gives the same bytes when its profile is given back.
#[test]
fn a_profile_gives_the_same_bytes() {
    let text = std::fs::read_to_string(corpus().join("manifest.toml")).unwrap();
    let manifest: Manifest = toml::from_str(&text).unwrap();
    for entry in manifest.file.iter().filter(|entry| entry.expect == "imported") {
        let files = || std::iter::once(&entry.file).chain(&entry.companions).map(|name| file(name)).collect::<Vec<_>>();
        let Ok(first) = import(files(), &options(entry)) else { continue };
        let profile = profile::Profile::from_toml("p", &first.profile.to_toml()).unwrap();
        let second = import(files(), &Options { profile, ..Options::default() });
        let second = second.unwrap_or_else(|error| panic!("{}: {error}\n{}", entry.file, first.profile.to_toml()));
        let [a, b] = [&first, &second].map(|recording| {
            let mut csv = Vec::new();
            recording.write_csv(&mut csv).unwrap();
            String::from_utf8(csv).unwrap()
        });
        assert!(a == b, "{}: {}", entry.file, first.profile.to_toml());
    }
}

/// Sensors and navigation of several files are one recording, and their profile gives it again.
#[test]
fn several_files_are_merged_by_time() {
    let whole = import(vec![file("other_names.csv")], &Options::default()).unwrap();
    let files = || vec![file("scalar_only.csv"), file("vectors_only.csv"), file("track.nmea")];
    let merged = import(files(), &Options::default()).unwrap();
    let [whole, first] = [&whole, &merged].map(|recording| {
        let mut csv = Vec::new();
        recording.write_csv(&mut csv).unwrap();
        csv
    });
    let (whole, made) = (table(&whole), table(&first));
    for name in ["scalar_nT", "flux_x_nT", "flux_z_nT"] {
        let (a, b) = (&whole[name], &made[name]);
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(a.len() == b.len() && off < 0.02, "{name}: {off}, {} of {} rows", b.len(), a.len());
    }
    assert!(made["latitude_deg"].iter().filter(|value| value.is_finite()).count() > 100);
    let profile = profile::Profile::from_toml("p", &merged.profile.to_toml()).unwrap();
    let again = import(files(), &Options { profile, ..Options::default() }).unwrap();
    let mut second = Vec::new();
    again.write_csv(&mut second).unwrap();
    assert!(first == second);
}
