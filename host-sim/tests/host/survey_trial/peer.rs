//! A peer's test: MagNav.jl's own compensation of 100 s of a flight, and its own demand, a standard deviation of the
//! difference of 0.1 nT. The recording is its own calibration, as there.

use super::csv_file::CsvFile;
use super::program::{self, Folder, calibrated, data, survey, text};
use super::statistics::std;
use super::table::{FREE, Figure, finish};

/// Standard deviation of the difference, nT, and how many rows have one.
fn difference(ours_nt: &[f64], peers_nt: &[f64]) -> (f64, usize) {
    let difference: Vec<f64> = ours_nt.iter().zip(peers_nt).map(|(a, b)| a - b).filter(|nt| !nt.is_nan()).collect();
    (std(&difference), difference.len())
}

#[test]
#[ignore = "needs the peer's recording and the survey; see the top of survey_trial.rs"]
fn peer() {
    let Some(recording) = data("peers/magnav_jl_tolles_lawson.csv") else { return };
    let folder = Folder::new("peer");
    let peers_nt = CsvFile::read(&recording).numbers("peer_compensated_nT");
    let coefficients = calibrated(&recording, &folder.file("calibration")).unwrap();
    let replayed = folder.file("replay");
    let replay = ["replay", text(&recording), "--method", "fixed", "--coefficients", text(&coefficients), "--out"];
    program::run(&[&replay[..], &[text(&replayed)]].concat()).unwrap();
    let mut figures = Vec::new();
    let mut figure = |name: &str, ours_nt: &[f64]| {
        let (nt, rows) = difference(ours_nt, &peers_nt);
        // All of the 100 s but at most the second that a causal filter may want.
        let is_whole = rows + 10 >= peers_nt.len();
        let asked = [if is_whole { nt } else { f64::NAN }, FREE[0], 0.1];
        figures.push(Figure::new(format!("{name}, nT"), asked, format!("{rows} of {} rows, {nt:.4}", peers_nt.len())));
    };
    figure("calibrate and replay, fixed", &CsvFile::read(&replayed.join("compensated.csv")).numbers("compensated_nT"));
    for (name, given) in [("survey", None), ("survey --coefficients", Some(coefficients.as_path()))] {
        let out = folder.file(name);
        survey(&recording, given, &out).unwrap();
        figure(name, &CsvFile::read(&out.join("levelled.csv")).numbers("field_nT"));
    }
    finish("Peer", &figures);
}
