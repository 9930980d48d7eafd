//! `host-sim emulate --serve`: the emulated body on the page, its faults too, and the result that it has without anybody looking.
//!
//! Builds nothing: without QEMU, or without the image of `cargo fw-emu`, it says so and passes. With `TOWMAG_EMULATION=required`,
//! as in CI, it fails then.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use host_sim::emulator::DEFAULT_IMAGE;

use super::parts::Viewer;
use super::shown_again;

pub(crate) const ROWS: usize = 600;
/// The scalar sensor is silent from this row on, for so many.
const SILENT: [usize; 2] = [300, 40];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The image, if there is one and an emulator for it.
pub(crate) fn image() -> Option<PathBuf> {
    let image = root().join(DEFAULT_IMAGE);
    let has_qemu = Command::new("qemu-system-arm").arg("--version").output().is_ok();
    if has_qemu && image.is_file() {
        return Some(image);
    }
    assert!(std::env::var_os("TOWMAG_EMULATION").is_none(), "emulation is required: {has_qemu}, {}", image.display());
    eprintln!("skipped: needs qemu-system-arm and the image that `cargo fw-emu` builds");
    None
}

/// An emulation that is ended with the test.
pub(crate) struct Emulation(pub(crate) Child);

impl Drop for Emulation {
    fn drop(&mut self) {
        _ = self.0.kill();
        _ = self.0.wait();
    }
}

pub(crate) fn emulation(folder: &Path, image: &Path, out: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    command.current_dir(folder).args(["emulate", "tow.csv", "--method", "saddle-point", "--out", out]).args(more);
    command.arg("--fault").arg(format!("drop@{}+{}", SILENT[0], SILENT[1])).arg("--image").arg(image);
    command.stdin(Stdio::null()).stdout(Stdio::null());
    command
}

/// The first rows of the sample, as `tow.csv`.
pub(crate) fn tow(folder: &Path, rows: usize) {
    let sample = fs::read_to_string(root().join("sample/survey.csv")).unwrap();
    let rows: String = sample.split_inclusive('\n').take(rows + 1).collect();
    fs::write(folder.join("tow.csv"), rows).unwrap();
}

/// Where an emulation serves, as `host:port`.
pub(crate) fn host(emulation: &mut Emulation) -> String {
    let told = BufReader::new(emulation.0.stderr.take().unwrap());
    let mut lines = told.lines().map_while(Result::ok);
    let line = lines.find(|line| line.contains("the page is at http://")).expect("it says where the page is");
    let host = line.rsplit_once("http://").unwrap().1.trim_end_matches('/').to_string();
    // What else it says must not fill the pipe.
    std::thread::spawn(move || lines.count());
    host
}

#[test]
fn a_rehearsal_shows_the_emulated_body_and_changes_nothing() {
    let Some(image) = image() else { return };
    let folder = tempfile::tempdir().unwrap();
    tow(folder.path(), ROWS);
    let watched = ["--serve", "127.0.0.1:0", "--speed", "30"];
    let mut watched = emulation(folder.path(), &image, "watched", &watched);
    let mut watched = Emulation(watched.stderr(Stdio::piped()).spawn().unwrap());
    let mut viewer = Viewer::connect(&host(&mut watched));
    let title = viewer.next("hello")["title"].clone();
    assert_eq!(title, "emulated tow.csv");
    let (mut shown, mut silent, begin) = (0, 0, Instant::now());
    while shown < ROWS * 9 / 10 && begin.elapsed() < Duration::from_secs(120) {
        for row in viewer.next("epochs")["rows"].as_array().unwrap() {
            shown += 1;
            silent += usize::from(row[2][0].is_null());
        }
    }
    assert!(shown >= ROWS * 9 / 10, "{shown} of {ROWS} epochs were shown");
    assert!((SILENT[1]..2 * SILENT[1]).contains(&silent), "{silent} of them without a reading");
    while !folder.path().join("watched/summary.json").is_file() {
        assert!(begin.elapsed() < Duration::from_secs(120), "the emulation has no end");
        std::thread::sleep(Duration::from_millis(50));
    }
    let alone = emulation(folder.path(), &image, "alone", &[]).output().unwrap();
    assert!(alone.status.success(), "{}", String::from_utf8_lossy(&alone.stderr));
    for name in ["compensated.csv", "summary.json", "log.bin"] {
        let read = |of: &str| fs::read(folder.path().join(of).join(name)).unwrap();
        assert!(read("watched") == read("alone"), "{name}");
    }
    // What the cable and the card have of it is shown again; the body runs a second longer than it is fed.
    let epochs = ROWS as u32 - 2..=ROWS as u32 + 20;
    for name in ["telemetry.bin", "log.bin"] {
        shown_again(folder.path().join("watched").join(name).to_str().unwrap(), epochs.clone(), false);
    }
}
