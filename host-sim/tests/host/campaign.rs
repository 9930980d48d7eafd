//! `campaign/`: a season of simulated recordings through Snakemake, cut and resumed, one of them bad.
//!
//! Installs nothing: without a python3 that has Snakemake it says so and passes. With the path of a Python in `TOWMAG_PYTHON`,
//! as in CI, that one must have it.

use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::of_repository;
use crate::common::python::{has_python, python};

/// Three calibrations, three tows of three bodies; the tow in the middle is bad.
const RECORDINGS: usize = 6;
const BAD: &str = "berta-0001";
const SUMMARY: [&str; 5] = ["contacts.csv", "coefficients.csv", "index.html", "recordings.csv", "summary.json"];

/// Whether there is a Python with the engine.
fn has_engine() -> bool {
    has_python("snakemake", "campaign/requirements.txt")
}

fn season(folder: &Path) {
    let recordings = RECORDINGS.to_string();
    let made = Command::new(python())
        .arg(of_repository("campaign/measure/make_season.py"))
        .args(["--host-sim", env!("CARGO_BIN_EXE_host-sim"), "--recordings", &recordings, "--bad", "1"])
        .args(["--seconds", "90"])
        .arg(folder)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let config = format!("host_sim: {}\npages: false\n", env!("CARGO_BIN_EXE_host-sim"));
    std::fs::write(folder.join("config.yaml"), config).unwrap();
}

fn engine(folder: &Path, arguments: &[&str]) -> Command {
    let mut engine = Command::new(python());
    engine
        .args(["-m", "snakemake", "--snakefile"])
        .arg(of_repository("campaign/Snakefile"))
        .arg("--directory")
        .arg(folder);
    engine.args(["--quiet", "all"]).args(arguments);
    // Its own cache of sources would go to the home of whoever runs the tests.
    engine.env("XDG_CACHE_HOME", folder.join("cache"));
    engine
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let done = engine(folder, arguments).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    done
}

/// Every file of the folder below with this ending.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut all = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true => all.extend(files(&path, ending)),
            false if path.to_string_lossy().ends_with(ending) => all.push(path),
            false => {}
        }
    }
    all
}

/// Kill the engine and all that it has started, as a power cut would, once so many steps are done.
fn cut(folder: &Path, steps: usize) {
    let mut started =
        engine(folder, &["--cores", "2"]).process_group(0).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let begin = Instant::now();
    while files(&folder.join("outcomes"), ".json").len() < steps {
        assert!(
            begin.elapsed() < Duration::from_secs(120) && started.try_wait().unwrap().is_none(),
            "no time to cut it"
        );
        sleep(Duration::from_millis(20));
    }
    let group = format!("-{}", started.id());
    assert!(Command::new("kill").args(["-9", "--", &group]).status().unwrap().success());
    started.wait().unwrap();
}

/// How often each step was begun.
fn begun(folder: &Path) -> Vec<usize> {
    let text = |log: PathBuf| std::fs::read_to_string(log).unwrap();
    files(&folder.join("logs"), ".log").into_iter().map(|log| text(log).matches("started: ").count()).collect()
}

fn same_summary(one: &Path, other: &Path) {
    for name in SUMMARY {
        let read = |folder: &Path| std::fs::read(folder.join("summary").join(name)).unwrap();
        assert!(read(one) == read(other), "{name} of {} and {}", one.display(), other.display());
    }
}

#[test]
fn a_campaign_that_is_cut_ends_with_the_bytes_of_one_that_is_not() {
    if !has_engine() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [whole, resumed] = ["whole", "resumed"].map(|name| folder.path().join(name));
    season(&whole);
    season(&resumed);
    run(&whole, &["--cores", "2"]);
    // What nobody can read leaves what follows out, and nothing else.
    let steps = begun(&whole);
    assert_eq!((steps.len(), steps.iter().max()), (RECORDINGS * 3 - 2, Some(&1)), "each step once");
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(whole.join("summary/summary.json")).unwrap()).unwrap();
    let problems = summary["problems"].as_array().unwrap();
    assert!(problems.len() == 1 && problems[0]["name"] == BAD, "{problems:?}");
    assert!(problems[0]["what"].as_str().unwrap().contains("raw/berta-0001.csv: holds no table"), "{problems:?}");
    assert_eq!((&summary["recordings"], &summary["diagnosed"]), (&RECORDINGS.into(), &(RECORDINGS - 1).into()));
    assert_eq!(summary["programs"][0]["version"], env!("CARGO_PKG_VERSION"));

    cut(&resumed, 4);
    assert!(!resumed.join("summary").exists());
    run(&resumed, &["--cores", "2", "--unlock"]);
    run(&resumed, &["--cores", "2"]);
    same_summary(&whole, &resumed);
    let twice = begun(&resumed).into_iter().filter(|times| *times > 1).collect::<Vec<_>>();
    assert!(twice.len() <= 2 && twice.iter().all(|times| *times == 2), "only what two cores were at: {twice:?}");

    // What somebody deletes is made again, and that alone, though the summary is there.
    let lost = whole.join("results/anna-0000/diagnosis/diagnosis.json");
    let bytes = std::fs::read(&lost).unwrap();
    std::fs::remove_file(&lost).unwrap();
    run(&whole, &["--cores", "1"]);
    assert!(std::fs::read(&lost).unwrap() == bytes);
    assert_eq!(begun(&whole).iter().sum::<usize>(), steps.len() + 1);
    same_summary(&whole, &resumed);
}

#[test]
fn a_trial_in_shards_is_the_trial_at_once() {
    if !has_engine() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let host_sim = env!("CARGO_BIN_EXE_host-sim");
    let trial = "trial: {seeds: [5], recordings: 3, shards: 3, options: [--minutes, 2]}";
    std::fs::write(folder.path().join("config.yaml"), format!("season: ''\nhost_sim: {host_sim}\n{trial}\n")).unwrap();
    run(folder.path(), &["--cores", "2"]);
    let alone = Command::new(host_sim)
        .args(["trial", "--quiet", "--seed", "5", "--recordings", "3", "--minutes", "2", "--out", "alone"])
        .current_dir(folder.path())
        .status()
        .unwrap();
    assert!(alone.success());
    for name in ["trial.json", "answers.json", "report.html"] {
        let read = |of: &str| std::fs::read(folder.path().join(of).join(name)).unwrap();
        assert!(read("alone") == read("trial/5/whole"), "{name}");
    }
    let summary = std::fs::read_to_string(folder.path().join("summary/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!((&summary["trials"][0]["seed"], &summary["trials"][0]["recordings"]), (&5.into(), &3.into()));
}

#[test]
fn the_parts_of_a_campaign_do_what_they_say() {
    if !has_engine() {
        return;
    }
    let tests = Command::new(python())
        .args(["-m", "unittest", "discover", "-s"])
        .arg(of_repository("campaign/tests"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&tests.stderr);
    assert!(tests.status.success() && said.contains("Ran ") && !said.contains("Ran 0 tests"), "{said}");
}

#[test]
fn a_table_that_is_wrong_is_refused_with_its_line() {
    if !has_engine() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let refused = |text: &str| {
        std::fs::write(folder.path().join("season.csv"), text).unwrap();
        let done = Command::new(python())
            .arg(of_repository("campaign/summary.py"))
            .args(["--out", "summary", "."])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(done.status.code(), Some(2));
        String::from_utf8(done.stderr).unwrap()
    };
    let head = "name,body,day,kind,file\n";
    let row = "a,anna,2026-06-20,tow,a.csv\n";
    assert!(refused("name,body\n").contains("season.csv:1: lacks the column day, kind, file"));
    assert!(refused(head).contains("names no recording"));
    assert!(refused(&format!("{head}{row}{row}")).contains("name a: is there twice"));
    assert!(refused(&format!("{head}{row}b,anna,20.6.2026,tow,b.csv\n")).contains("season.csv:3: day '20.6.2026'"));
    assert!(refused(&format!("{head}../a,anna,2026-06-20,tow,a.csv\n")).contains("season.csv:2: name '../a'"));
    assert!(refused(&format!("{head}a,anna,2026-06-20,flight,a.csv\n")).contains("must be calibration or tow"));
    let asks = "name,body,day,kind,file,calibration\na,anna,2026-06-20,tow,a.csv,z\n";
    assert!(refused(asks).contains("calibration z: no recording of that kind"));
}
