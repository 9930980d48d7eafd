//! What measures: the host program, and cargo.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use tempfile::TempDir;

use crate::repository;

/// The host program, and a folder for what it writes.
pub struct Tools {
    host_sim: PathBuf,
    folder: TempDir,
}

impl Tools {
    /// Builds the host program in release if it is not, or takes the one that `cargo test` has built.
    pub fn new(is_release: bool) -> Result<Self> {
        if is_release {
            cargo(&["build", "--quiet", "--release", "-p", "host-sim"])?;
        }
        let folder = repository::target_folder().join(if is_release { "release" } else { "debug" });
        let host_sim = folder.join(format!("host-sim{}", std::env::consts::EXE_SUFFIX));
        ensure!(host_sim.is_file(), "{}: run cargo test first", host_sim.display());
        Ok(Self { host_sim, folder: tempfile::tempdir()? })
    }

    /// A path that is gone when all is measured.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// What the host program prints, called at the root of the repository.
    pub fn host_sim(&self, arguments: &[&str]) -> Result<String> {
        output(Command::new(&self.host_sim).args(arguments))
    }

    /// The same with results in a folder of their own, and one JSON file of them.
    pub fn host_sim_json(&self, arguments: &[&str], file: &str) -> Result<Value> {
        let out = self.path("out");
        self.host_sim(&[arguments, &["--out", text(&out)?]].concat())?;
        let json = std::fs::read(out.join(file)).with_context(|| format!("{} of {arguments:?}", file))?;
        Ok(serde_json::from_slice(&json)?)
    }

    /// How long the host program takes, the shortest of three times.
    pub fn shortest(&self, arguments: &[&str]) -> Result<Duration> {
        let mut shortest = Duration::MAX;
        for _ in 0..3 {
            let begin = Instant::now();
            self.host_sim(arguments)?;
            shortest = shortest.min(begin.elapsed());
        }
        Ok(shortest)
    }
}

/// A path as an argument.
pub fn text(path: &Path) -> Result<&str> {
    path.to_str().with_context(|| format!("{} is not UTF-8", path.display()))
}

/// What cargo prints, called at the root of the repository.
pub(super) fn cargo(arguments: &[&str]) -> Result<String> {
    output(Command::new(env!("CARGO")).args(arguments))
}

/// The lines that a test prints. An emulator is required where the test knows one.
pub(super) fn test_lines(package: &str, test: &str, filter: &str) -> Result<Vec<String>> {
    let arguments = ["test", "--quiet", "-p", package, "--test", test, filter, "--", "--nocapture", "--test-threads=1"];
    let printed = output(Command::new(env!("CARGO")).args(arguments).env("TOWMAG_EMULATION", "required"))?;
    Ok(printed.lines().map(str::to_string).collect())
}

/// Where the flight recordings are, if they are: the tests look there too.
pub(super) fn flights() -> Option<PathBuf> {
    let beside = repository::root().join("../shared/data");
    let folder = std::env::var_os("TOWMAG_DATA").map_or(beside, PathBuf::from).join("sgl_line_1002_20");
    folder.is_dir().then_some(folder)
}

/// Whether the firmware can be emulated here.
pub(super) fn has_emulator() -> bool {
    Command::new("qemu-system-arm").arg("--version").output().is_ok()
}

fn output(command: &mut Command) -> Result<String> {
    let Output { status, stdout, stderr } =
        command.current_dir(repository::root()).output().with_context(|| format!("{command:?}"))?;
    if !status.success() {
        bail!("{command:?}: {status}\n{}{}", String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    }
    Ok(String::from_utf8(stdout)?)
}

/// The processor, for figures that are its own.
pub(super) fn processor() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    format!("{}, {cores} cores", model.map_or("unknown processor", |(_, name)| name.trim()))
}
