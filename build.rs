//! Memory map and link arguments of the firmware, and for it alone: tests on the host and `--lib` builds link without.

use std::path::PathBuf;
use std::process::Command;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    let is_target = env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("none");
    if !is_target || env::var_os("CARGO_FEATURE_FIRMWARE").is_none() {
        return Ok(());
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    let memory = memory_map();
    println!("cargo:rerun-if-changed={}", memory.display());
    fs::copy(memory, out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());
    for argument in ["--nmagic", "--emit-relocs", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo:rustc-link-arg-bin=firmware={argument}");
    }
    println!("cargo:rerun-if-changed=.git/HEAD");
    println!("cargo:rustc-env=TOWMAG_COMMIT={}", commit());
    Ok(())
}

/// The memory map of the board whose feature is on, if it has one of its own in the folder of that name, else that of the
/// STM32F405RG.
fn memory_map() -> PathBuf {
    let features = env::vars().filter_map(|(name, _)| Some(name.strip_prefix("CARGO_FEATURE_")?.to_lowercase()));
    let mut own = features.map(|feature| PathBuf::from(format!("src/board/{feature}/memory.x")));
    own.find(|path| path.is_file()).unwrap_or_else(|| PathBuf::from("memory.x"))
}

/// The commit of the source, forty digits, and a `+` when the source has been changed since; zeros outside a clone.
fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        String::from_utf8(output.stdout).ok()
    };
    let commit = git(&["rev-parse", "HEAD"]).map_or("0".repeat(40), |text| text.trim().to_string());
    let changed = git(&["status", "--porcelain"]).is_some_and(|text| !text.trim().is_empty());
    if changed { commit + "+" } else { commit }
}
