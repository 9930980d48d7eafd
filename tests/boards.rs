//! The house rules of the boards: one place chooses among them, and nothing else knows the hardware.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

/// Files of `src`, relative to it, that hold one of `words`.
fn files_with(words: &[&str]) -> Vec<String> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found: Vec<String> = sources(&src)
        .into_iter()
        .filter(|path| {
            let text = fs::read_to_string(path).unwrap();
            words.iter().any(|word| text.contains(word))
        })
        .map(|path| path.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/"))
        .collect();
    found.sort();
    found
}

#[test]
fn one_file_chooses_the_board() {
    assert_eq!(files_with(&["feature ="]), ["board/mod.rs"]);
}

#[test]
fn only_the_boards_know_the_chip() {
    let files = files_with(&["stm32f4xx_hal", "cortex_m"]);
    assert!(!files.is_empty() && files.iter().all(|file| file.starts_with("board/")), "{files:?}");
}
