//! What is fuzzed of the importer: whole files, every reader of a format on any bytes, profiles, stamps. Each function takes
//! any bytes and panics when a promise is broken. The fuzzers and the tests of the kept corpora call the same functions.

use towmag_import::formats::{FORMATS, Input as FormatInput};
use towmag_import::profile::{Profile, parse_axes};
use towmag_import::source::Source;
use towmag_import::{File, ImportError, Input, Options, Recording, import};

/// So much of a file is shown to those that recognise formats.
const SHOWN: usize = 1 << 16;

/// A file, most often of text: refused in words, or a recording; its profile, given back, gives the same bytes.
pub fn import_text(data: &[u8]) {
    let Some(recording) = imported(data, Options::default()) else { return };
    let written = csv(&recording);
    let lines = written.iter().filter(|byte| **byte == b'\n').count();
    assert!(lines > recording.report.rows_out, "{lines} lines of {} rows", recording.report.rows_out);
    assert!(recording.report.rows_invalid <= recording.report.rows_out);
    let profile = read_again(&recording.profile);
    let again = imported(data, Options { profile, ..Options::default() }).expect("with its own profile");
    assert!(csv(&again) == written, "another recording with its own profile:\n{}", recording.profile.to_toml());
}

/// Any bytes, given to every reader whether it takes them for its own or not, and to the import.
pub fn import_formats(data: &[u8]) {
    for format in FORMATS {
        format.recognises(&data[..data.len().min(SHOWN)]);
        let companions = [("f.dat".to_string(), data.to_vec())];
        for companions in [&companions[..], &[]] {
            match format.read(&FormatInput { file: "f", bytes: data, companions, part: None }) {
                Ok(source) => check_source(&source),
                Err(error) => check_error(&error),
            }
            if !format.takes_companions() {
                break;
            }
        }
    }
    imported(data, Options::default());
}

/// A profile, axes and stamps of any text: what is read is written as it was, and no import of a good file panics with it.
pub fn import_profile(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    for line in text.lines() {
        if let Ok(axes) = parse_axes(line) {
            assert_eq!(axes.map(|axis| axis.of).iter().sum::<usize>(), 3, "{line}");
        }
    }
    imported(of_stamps(&text).as_bytes(), Options::default());
    match Profile::from_toml("f.toml", &text) {
        Ok(profile) => {
            let profile = read_again(&profile);
            imported(GOOD, Options { profile, ..Options::default() });
        }
        Err(error) => check_error(&error),
    }
}

/// Each line as the time of a row.
fn of_stamps(text: &str) -> String {
    let rows = text.lines().take(LONGEST_TABLE).map(|stamp| format!("{stamp}|50000.5\n"));
    std::iter::once("time|scalar_nT\n".to_string()).chain(rows).collect()
}

/// Rows are made of so many lines at most.
const LONGEST_TABLE: usize = 64;

/// A file that profiles are tried on.
const GOOD: &[u8] = b"time,mag,fx,fy,fz,Tiefe\n\
    10:00:00.0,50000.1,20000,1000,45000,3.1\n10:00:00.1,50000.2,20001,1001,45001,3.2\n\
    10:00:00.2,50000.3,20002,1002,45002,3.3\n10:00:00.3,50000.4,20003,1003,45003,3.4\n";

fn imported(data: &[u8], options: Options) -> Option<Recording> {
    let file = File { name: "f".into(), bytes: data.to_vec() };
    import(vec![Input::File(file)], &options).inspect_err(check_error).ok()
}

fn csv(recording: &Recording) -> Vec<u8> {
    let mut written = Vec::new();
    recording.write_csv(&mut written).expect("memory");
    written
}

/// What is written of a profile, read.
fn read_again(profile: &Profile) -> Profile {
    let text = profile.to_toml();
    let read = Profile::from_toml("again", &text).unwrap_or_else(|error| panic!("{error} in\n{text}"));
    assert_eq!(read.to_toml(), text);
    read
}

fn check_source(source: &Source) {
    for table in &source.tables {
        assert!(table.columns.iter().all(|column| column.values.len() == table.rows), "{}", source.format);
        assert!(table.places.is_empty() || table.places.len() == table.rows, "{}", source.format);
    }
}

/// A refusal says what is wrong.
fn check_error(error: &ImportError) {
    assert!(error.to_string().len() > 10, "{error}");
}
