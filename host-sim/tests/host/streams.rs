//! Pipes, compressed files, what is no recording at all, results among other people's files, and being told to stop.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{done, host_sim, of_repository, refused, text, without_marks};
use flate2::Compression;
use flate2::write::GzEncoder;

fn calibration() -> Vec<u8> {
    fs::read(of_repository("sample/calibration.csv")).unwrap()
}

fn begun(arguments: &[&str], temporary: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    command.args(arguments).env("TMPDIR", temporary);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn fed(arguments: &[&str], bytes: &[u8]) -> Output {
    let temporary = tempfile::tempdir().unwrap();
    let mut child = begun(arguments, temporary.path());
    child.stdin.take().unwrap().write_all(bytes).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(fs::read_dir(temporary.path()).unwrap().count(), 0, "the copy is gone");
    output
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn a_recording_may_come_through_any_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    done(&["calibrate", text(&of_repository("sample/calibration.csv")), "--out", text(&path("file"))]);
    let terms = |name: &str| {
        let file = fs::read_to_string(path(name).join("coefficients.toml")).unwrap();
        file[file.find("[[term]]").unwrap()..].to_string()
    };
    let compressed = path("cal.csv.gz");
    fs::write(&compressed, gzip(&calibration())).unwrap();
    done(&["calibrate", text(&compressed), "--out", text(&path("gzip"))]);
    for (name, recording, bytes) in
        [("dash", "-", calibration()), ("device", "/dev/stdin", calibration()), ("both", "-", gzip(&calibration()))]
    {
        let output = fed(&["calibrate", recording, "--out", text(&path(name))], &bytes);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let fifo = path("fifo");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let writer = std::thread::spawn({
        let fifo = fifo.clone();
        move || fs::write(fifo, calibration()).unwrap()
    });
    done(&["calibrate", text(&fifo), "--out", text(&path("named"))]);
    writer.join().unwrap();
    assert!(["gzip", "dash", "device", "both", "named"].iter().all(|name| terms(name) == terms("file")));
    let page = fs::read_to_string(path("dash").join("report.html")).unwrap();
    assert!(page.contains("Calibration: standard input"));
    let bad = fed(&["replay", "-", "--strict", "--out", text(&path("bad"))], b"time_s,scalar_nT\n");
    assert_eq!(bad.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bad.stderr).starts_with("standard input:1: required columns are missing"));
}

#[test]
fn simulate_writes_into_a_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let (scenario, file) = (of_repository("scenarios/land_calibration.toml"), folder.path().join("rec.csv"));
    done(&["simulate", text(&scenario), "--out", text(&file)]);
    let output = host_sim(&["simulate", text(&scenario), "--out", "-"]);
    assert!(output.status.success() && output.stdout == fs::read(&file).unwrap());
    assert!(String::from_utf8_lossy(&output.stderr).contains(" rows, seed "));
    let quiet = host_sim(&["simulate", text(&scenario), "--out", "-", "--quiet"]);
    assert!(quiet.stdout == output.stdout && quiet.stderr.is_empty());
    assert!(!Path::new("-").exists());
}

#[test]
fn what_is_no_recording_is_named_with_what_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        refused(&["replay", text(&path), "--out", text(&folder.path().join("out"))])
    };
    let card = refusal("card.img", &[0; 4096]);
    assert!(card.contains("card.img:1: is no text") && card.contains("host-sim recover "), "{card}");
    assert!(refusal("table.xlsx", b"PK\x03\x04rest").contains("save the table as CSV"));
    let compressed = gzip(&calibration());
    let cut = refusal("cut.csv.gz", &compressed[..compressed.len() / 2]);
    assert!(cut.contains("cut.csv.gz: cannot be read: the gzip file is cut or damaged"), "{cut}");
}

#[test]
fn nobody_elses_file_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join("summary.json"), "{}").unwrap();
    let survey = without_marks(folder.path());
    let replay = ["replay", text(&survey), "--out", text(&out), "--method", "none"];
    let line = refused(&replay);
    assert!(
        line.contains("out/summary.json: is there already and is no result of host-sim: name another folder"),
        "{line}"
    );
    assert_eq!(fs::read_to_string(out.join("summary.json")).unwrap(), "{}");
    fs::remove_file(out.join("summary.json")).unwrap();
    done(&replay);
    done(&replay);
    // The folder is ours by now, and what is not in its list is still not.
    fs::write(out.join("coefficients.toml"), "mine").unwrap();
    let calibration = of_repository("sample/calibration.csv");
    let line = refused(&["calibrate", text(&calibration), "--out", text(&out)]);
    assert!(line.contains("out/coefficients.toml: is there already"), "{line}");
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
    // A trial writes its files one by one.
    let (trial, arguments) = (folder.path().join("trial"), ["--recordings", "1", "--minutes", "2"]);
    let trial_in = ["trial", "--out", text(&trial)];
    let of_trial = [&trial_in[..], &arguments[..]].concat();
    done(&of_trial);
    done(&of_trial);
    fs::remove_file(trial.join(".host-sim")).unwrap();
    assert!(refused(&of_trial).contains("trial/answers.json: is there already"));
}

/// Everything below a folder whose name says that it is not finished.
fn unfinished(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with(".host-sim-")).collect()
}

fn told_to_stop(signal: &str) {
    let folder = tempfile::tempdir().unwrap();
    let (temporary, results) = (folder.path().join("tmp"), folder.path().join("results"));
    fs::create_dir(&temporary).unwrap();
    let mut child = begun(&["calibrate", "-", "--out", text(&results.join("a/out"))], &temporary);
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(&calibration()[..100_000]).unwrap();
    let patience = Instant::now() + Duration::from_secs(20);
    while !(results.join("a").is_dir()
        && unfinished(&results.join("a")).len() == 1
        && unfinished(&temporary).len() == 1)
    {
        assert!(Instant::now() < patience, "it never began");
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    drop(stdin);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(130), 0), "{signal}");
    assert!(!results.exists(), "folders made on the way are gone too");
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
}

#[test]
fn nothing_half_done_stays_when_it_is_told_to_stop() {
    told_to_stop("-INT");
    told_to_stop("-TERM");
}

#[test]
fn quiet_prints_nothing_but_what_must_be_known() {
    let folder = tempfile::tempdir().unwrap();
    let (out, survey) = (folder.path().join("out"), without_marks(folder.path()));
    assert_eq!(done(&["--quiet", "replay", text(&survey), "--out", text(&out)]), "");
    assert!(done(&["replay", "--quiet", "--json", text(&survey), "--out", text(&out)]).starts_with("{\n"));
    assert!(refused(&["replay", "--quiet", "none.csv", "--out", text(&out)]).starts_with("none.csv: cannot be read"));
}

#[test]
fn shells_and_man_know_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = done(&["completions", shell]);
        assert!(["replay", "diagnose", "strict", "coefficients"].iter().all(|word| script.contains(word)), "{shell}");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("man");
    done(&["man", "--out", text(&out)]);
    let page = fs::read_to_string(out.join("host-sim-replay.1")).unwrap();
    assert!(page.contains(".TH host\\-sim\\-replay 1") || page.contains(".TH host-sim-replay 1"), "{page}");
    assert!(page.contains("\\-\\-coefficients"));
    assert!(out.join("host-sim.1").is_file() && out.join("host-sim-card-prepare.1").is_file());
}
