//! The page in a real browser.
#![cfg(not(target_os = "none"))]

#[path = "report/demo.rs"]
mod demo;

use host_sim::report::{Kind, render};
use std::path::PathBuf;

#[test]
fn write() {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    for (name, kind, rows) in [
        ("compare", Kind::Compare, 26_000),
        ("replay", Kind::Replay, 3_000),
        ("calibrate", Kind::Calibrate, 9_000),
        ("long", Kind::Compare, 400_000),
    ] {
        let page = render(&demo::report(kind, rows)).unwrap();
        eprintln!("{name} {}", page.len());
        std::fs::write(directory.join(format!("{name}.html")), page).unwrap();
    }
}
