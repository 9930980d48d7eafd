//! `cargo xtask shape`: how long functions are, area by area.

use crate::repository;
use crate::structure::functions::{Function, Shape, functions};
use crate::structure::{SourceCrate, on_disk};

/// Area and the folders that it is made of, the first that fits.
const AREAS: [(&str, &str); 7] = [
    ("board", "src/board/"),
    ("core and firmware", "src/"),
    ("diagnosis", "host-sim/src/diagnosis/"),
    ("host-sim, the rest", "host-sim/src/"),
    ("trial", "trial/"),
    ("fuzz", "fuzz/"),
    ("xtask", "xtask/"),
];

/// A table of median, nine in ten, and longest, in lines of the body.
pub fn table() -> String {
    let mut all: Vec<Function> = Vec::new();
    for root in repository::crates() {
        all.extend(functions(&SourceCrate::parse(&root.path, &on_disk)));
    }
    let mut rows = String::from("| functions | count | median | p90 | longest |\n|---|---|---|---|---|\n");
    for (name, folder) in AREAS {
        let (inside, rest): (Vec<_>, Vec<_>) = all.into_iter().partition(|function| function.file.starts_with(folder));
        all = rest;
        let Shape { count, median, p90, longest } = Shape::of(&inside);
        if count > 0 {
            rows += &format!("| {name} | {count} | {median} | {p90} | {longest} |\n");
        }
    }
    rows
}
