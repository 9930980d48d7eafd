//! What is hidden in a made recording, where a file beside it says so: `REC.targets.csv` of `REC.csv`.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::message::file_name;
use crate::report::{Mark, ReportData};
use crate::simulator::Target;
use crate::text::number::short;

/// A line of the file.
#[derive(Deserialize, Serialize)]
#[allow(non_snake_case)] // the contract writes units as `nT`
struct Line {
    time_s: f64,
    peak_nT: f64,
    width_s: f64,
}

/// Where the file of a recording is.
fn beside(recording: &Path) -> PathBuf {
    recording.with_extension("targets.csv")
}

/// The file of `targets`.
pub(super) fn file_of(targets: &[Target]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for target in targets {
        let line = Line { time_s: target.time_s, peak_nT: target.peak_nt, width_s: target.width_s };
        csv.serialize(line).expect("memory takes it");
    }
    csv.into_inner().expect("memory takes it")
}

/// Mark on the page what the file beside `recording` says; nothing without one.
pub(super) fn mark_hidden(report: &mut ReportData, recording: &Path) {
    let Hidden { marks, note, warning } = hidden(recording);
    report.marks.extend(marks);
    report.marks_note = report.marks_note.take().or(note);
    report.warnings.extend(warning);
}

/// Marks for the page, and what it says of them.
struct Hidden {
    marks: Vec<Mark>,
    note: Option<String>,
    /// Why the file is of no use, if it is there and is not.
    warning: Option<String>,
}

/// What the file beside `recording` says.
fn hidden(recording: &Path) -> Hidden {
    let path = beside(recording);
    let nothing = |warning| Hidden { marks: Vec::new(), note: None, warning };
    if !path.is_file() {
        return nothing(None);
    }
    let name = file_name(&path);
    let lines: Result<Vec<Line>, csv::Error> =
        csv::Reader::from_path(&path).and_then(|mut csv| csv.deserialize().collect());
    let lines = match lines {
        Ok(lines) => lines,
        Err(why) => return nothing(Some(format!("{name} is not shown: {why}"))),
    };
    let mark = |line: &Line| Mark {
        time_s: line.time_s,
        label: format!("{}{} nT", if line.peak_nT > 0.0 { "+" } else { "" }, short(line.peak_nT)),
    };
    let marks: Vec<Mark> = lines.iter().map(mark).collect();
    let told: Vec<String> = marks.iter().map(|mark| format!("{} at {} s", mark.label, mark.time_s)).collect();
    let note = (!marks.is_empty()).then(|| format!("Hidden in this recording, as {name} tells: {}.", told.join(", ")));
    Hidden { marks, note, warning: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_and_damage_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let recording = folder.path().join("tow.csv");
        assert!(hidden(&recording).marks.is_empty() && hidden(&recording).warning.is_none());
        let target = Target { time_s: 371.0, peak_nt: -6.0, width_s: 2.0 };
        std::fs::write(folder.path().join("tow.targets.csv"), file_of(&[target])).unwrap();
        let read = hidden(&recording);
        assert_eq!(read.marks, [Mark { time_s: 371.0, label: "−6 nT".into() }]);
        assert!(read.note.unwrap().contains("tow.targets.csv tells: −6 nT at 371 s"));
        std::fs::write(folder.path().join("tow.targets.csv"), "time_s,peak_nT,width_s\n371,loud,2\n").unwrap();
        assert!(hidden(&recording).warning.unwrap().starts_with("tow.targets.csv is not shown: "));
    }
}
