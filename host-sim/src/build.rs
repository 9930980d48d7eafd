//! The commit of the source, for what a result tells of where it comes from.

use std::env;
use std::process::Command;

/// The folders that the program is made of. When one of them changes it is built anyway, and the commit is asked for anew; a
/// commit alone builds nothing again, and the program tells the commit that its source was last built at.
const SOURCES: [&str; 9] = [
    ".",
    "../../src",
    "../../card/src",
    "../../export/src",
    "../../import/src",
    "../../live/src",
    "../../recording/src",
    "../../survey/src",
    "../../trial/src",
];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    SOURCES.iter().for_each(|folder| println!("cargo:rerun-if-changed={folder}"));
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        println!("cargo:rustc-env=TOWMAG_COMMIT={}", commit().unwrap_or_default());
    }
}

/// Forty digits, and a `+` when the source has been changed since; `None` outside a clone.
fn commit() -> Option<String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        String::from_utf8(output.stdout).ok()
    };
    let commit = git(&["rev-parse", "HEAD"])?.trim().to_string();
    let is_changed = git(&["status", "--porcelain"]).is_none_or(|text| !text.trim().is_empty());
    Some(if is_changed { commit + "+" } else { commit })
}
