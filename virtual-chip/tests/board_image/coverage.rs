//! Which lines of the board's own code no test runs: those of `firmware/unrun_lines.toml`, which says what a line is, and
//! no others.

use crate::bench::{IMAGE, SEEN};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use towmag_virtual_chip::lines::{Line, Lines};

/// Most that may be listed, parts of a hundred of all lines.
const MOST_PERCENT: usize = 10;

/// No block of code is longer, bytes.
const LONGEST_BLOCK: u32 = 2_000;

#[derive(Deserialize)]
struct List {
    unrun: Vec<Unrun>,
}

/// Lines of a file that no test runs, and why.
#[derive(Deserialize)]
struct Unrun {
    file: String,
    lines: Vec<String>,
    reason: String,
}

/// File and text.
type Text = (String, String);

fn is_of_the_board(path: &str) -> bool {
    path.starts_with("src/board/") && !path.starts_with("src/board/emulated/")
}

#[test]
fn the_lines_that_no_test_runs_are_those_of_the_list() {
    crate::SCENARIOS.iter().for_each(|scenario| _ = crate::Scenario::force(scenario));
    let seen = SEEN.lock().expect("no test has panicked in there").clone();
    let lines = Lines::read(&IMAGE).with_code(is_of_the_board);
    let unrun = lines.iter().filter(|(_, pieces)| !pieces.iter().any(|at| has_run(&seen, *at)));
    let unrun: BTreeSet<Text> = unrun.map(|(line, _)| text(line)).collect();
    let percent = 100 * unrun.len() / lines.len();
    println!("{} of {} lines, {percent} %", unrun.len(), lines.len());
    let listed = listed();
    let new: Vec<_> = unrun.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&unrun).collect();
    assert!(new.is_empty(), "no test runs these, and firmware/unrun_lines.toml does not list them: {new:#?}");
    assert!(gone.is_empty(), "firmware/unrun_lines.toml lists what is run or has no code: {gone:#?}");
    assert!(percent <= MOST_PERCENT, "{percent} % of the board's lines are run by no test");
}

fn listed() -> BTreeSet<Text> {
    let list: List = toml::from_str(&source("firmware/unrun_lines.toml")).expect("a list of lines");
    assert!(list.unrun.iter().all(|unrun| !unrun.reason.is_empty()));
    let texts = |unrun: Unrun| unrun.lines.into_iter().map(move |line| (unrun.file.clone(), line));
    list.unrun.into_iter().flat_map(texts).collect()
}

fn text((path, line): &Line) -> Text {
    let source = source(path);
    let text = source.lines().nth(*line as usize - 1).expect("the image is of these sources: run `cargo fw` again");
    (path.clone(), text.trim().to_string())
}

fn source(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Whether a block that has run holds this address.
fn has_run(seen: &BTreeMap<u32, u32>, address: u32) -> bool {
    let mut before = seen.range(address.saturating_sub(LONGEST_BLOCK)..=address);
    before.any(|(begin, size)| address < begin + size)
}
