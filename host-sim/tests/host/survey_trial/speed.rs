//! Time and memory of a survey of an hour: a figure for docs/measured.md, from a program built with `--release` and given as
//! `HOST_SIM`. Linux alone says how much a process has used.

use std::process::Command;
use std::time::{Duration, Instant};

use host_sim::simulator::scenario::{Scenario, Simulation};

use super::program::{Folder, program, text};
use super::table::{FREE, Figure, finish};

const SURVEY: &str = include_str!("../../../../scenarios/survey_tow.toml");

/// Largest resident size of a process so far, MB.
fn peak_mb(id: u32) -> Option<f64> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kb: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kb * 1024.0 / 1e6)
}

#[test]
#[ignore = "an hour of data, and a program built with --release; see the top of survey_trial.rs"]
fn speed() {
    let folder = Folder::new("speed");
    let mut scenario = Scenario::parse(SURVEY).unwrap();
    scenario.duration_s = 3600.0;
    let (recording, out) = (folder.file("hour.csv"), folder.file("survey"));
    let mut bytes = Vec::new();
    Simulation::new(&scenario, 701).unwrap().record(&[]).write_csv(&mut bytes).unwrap();
    std::fs::write(&recording, bytes).unwrap();
    let begin = Instant::now();
    let mut child =
        Command::new(program()).args(["survey", text(&recording), "--quiet", "--out", text(&out)]).spawn().unwrap();
    let mut peak = f64::NAN;
    let status = loop {
        peak = peak_mb(child.id()).map_or(peak, |mb| mb.max(peak));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let wall_s = begin.elapsed().as_secs_f64();
    assert!(status.success());
    let page_mb = std::fs::metadata(out.join("report.html")).unwrap().len() as f64 / 1e6;
    finish(
        "Speed",
        &[
            Figure::new("An hour, s", [wall_s, FREE[0], 20.0], ""),
            Figure::new("Peak memory, MB", [peak, FREE[0], 500.0], ""),
            Figure::new("Page, MB", [page_mb, FREE[0], 1.5], ""),
        ],
    );
}
