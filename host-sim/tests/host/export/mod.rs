//! `host-sim export` as a user runs it. What is in the files is tested where they are made.

use std::path::Path;

use tempfile::TempDir;

use crate::common::{done, host_sim, refused, text};

const RECORDING: &str = "\
time_s,scalar_nT,latitude_deg,longitude_deg,line\n0.1,50000.5,-33.5,151.5,7\n0.2,50001.5,-33.4,151.6,7\n";

/// A folder with a recording in it.
fn with_recording() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("rec.csv"), RECORDING).unwrap();
    folder
}

fn export(input: &Path, format: &str, out: &Path) -> String {
    done(&["export", text(input), "--format", format, "--out", text(out)])
}

#[test]
fn every_format_is_written() {
    let folder = with_recording();
    let input = folder.path().join("rec.csv");
    let starts: [(&str, &[u8]); 6] = [
        ("xyz", b"/ \"rec.csv\"\n"),
        ("geojson", b"{\"type\":\"FeatureCollection\""),
        ("gpkg", b"SQLite format 3\0"),
        ("parquet", b"PAR1"),
        ("mcap", b"\x89MCAP0\r\n"),
        ("hdf5", b"\x89HDF\r\n\x1a\n"),
    ];
    for (format, start) in starts {
        let out = folder.path().join("made").join(format);
        let said = export(&input, format, &out);
        let expected = format!("{}: 2 rows and 5 columns to {} as {format}.\n", input.display(), out.display());
        assert_eq!(said, expected);
        assert!(std::fs::read(&out).unwrap().starts_with(start), "{format}");
    }
    assert_eq!(std::fs::read_to_string(&input).unwrap(), RECORDING);
}

#[test]
fn text_goes_to_stdout_and_nothing_else_does() {
    let folder = with_recording();
    let input = folder.path().join("rec.csv");
    for format in ["xyz", "geojson"] {
        let out = folder.path().join(format);
        export(&input, format, &out);
        assert_eq!(export(&input, format, Path::new("-")), std::fs::read_to_string(out).unwrap());
    }
    let said = refused(&["export", text(&input), "--format", "gpkg", "--out", "-"]);
    assert_eq!(said, "--out -: gpkg is no text: name a file");
}

#[test]
fn of_a_result_the_table_that_holds_most_is_taken() {
    let folder = with_recording();
    let out = folder.path().join("out.xyz");
    assert!(
        refused(&["export", text(folder.path()), "--format", "xyz", "--out", text(&out)]).contains("holds none of")
    );
    for name in ["recording.csv", "levelled.csv", "compensated.csv"] {
        let table = folder.path().join(name);
        std::fs::write(&table, RECORDING).unwrap();
        assert!(export(folder.path(), "xyz", &out).starts_with(&format!("{}: 2 rows", table.display())));
    }
}

#[test]
fn an_input_is_never_written_over() {
    let folder = with_recording();
    let input = folder.path().join("rec.csv");
    let same = folder.path().join("../").join(folder.path().file_name().unwrap()).join("rec.csv");
    let said = refused(&["export", text(&input), "--format", "xyz", "--out", text(&same)]);
    assert!(said.ends_with("would be replaced by its export"), "{said}");
    assert_eq!(std::fs::read_to_string(&input).unwrap(), RECORDING);
}

#[test]
fn bad_input_leaves_the_last_export_alone() {
    let folder = with_recording();
    let (input, out) = (folder.path().join("rec.csv"), folder.path().join("out.mcap"));
    std::fs::write(&out, "yesterday's").unwrap();
    std::fs::write(&input, RECORDING.replace("50001.5", "5o001.5")).unwrap();
    let said = refused(&["export", text(&input), "--format", "mcap", "--out", text(&out)]);
    assert_eq!(said, format!("{}:3: scalar_nT: \"5o001.5\" is not a number", input.display()));
    assert_eq!(std::fs::read_to_string(&out).unwrap(), "yesterday's");
    let names = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(names, 2);
}

#[test]
fn options_that_a_format_has_not_are_refused() {
    let folder = with_recording();
    let (input, out) = (folder.path().join("rec.csv"), folder.path().join("out"));
    let arguments = |format, every| -> Vec<String> {
        ["export", text(&input), "--format", format, "--out", text(&out), "--every", every].map(String::from).to_vec()
    };
    for (format, every, what) in [("xyz", "1", "are for --format geojson"), ("geojson", "0", "must be above 0 s")] {
        let arguments = arguments(format, every);
        let said = refused(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(said.ends_with(what), "{said}");
    }
    let unknown = host_sim(&["export", text(&input), "--format", "shp", "--out", text(&out)]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(!out.exists());
}
