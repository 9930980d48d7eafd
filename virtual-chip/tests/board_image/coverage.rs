//! Which lines of the board's own code no test runs.

use crate::bench::{IMAGE, SEEN};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;
use towmag_virtual_chip::lines::{Line, Lines};

fn is_of_the_board(path: &str) -> bool {
    path.starts_with("src/board/") && !path.starts_with("src/board/emulated/")
}

#[test]
fn the_lines_that_no_test_runs_are_those_of_the_list() {
    crate::SCENARIOS.iter().for_each(|scenario| _ = LazyLock::force(scenario));
    let seen = SEEN.lock().unwrap().clone();
    let lines = Lines::read(&IMAGE).with_code(is_of_the_board);
    let unrun: BTreeSet<&Line> = lines.iter().filter(|(_, pieces)| !pieces.iter().any(|at| has_run(&seen, *at))).map(|(line, _)| line).collect();
    println!("{} of {} lines unrun", unrun.len(), lines.len());
    for (path, line) in &unrun {
        let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap();
        println!("{path}:{line}: {}", text.lines().nth(*line as usize - 1).unwrap_or(""));
    }
}

/// Whether a block that has run holds this address.
fn has_run(seen: &BTreeMap<u32, u32>, address: u32) -> bool {
    // No block is longer than this.
    let mut before = seen.range(address.saturating_sub(2_000)..=address);
    before.any(|(begin, size)| address < begin + size)
}
