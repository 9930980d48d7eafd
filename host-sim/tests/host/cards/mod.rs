//! `host-sim card` as a user runs it, on images and folders. Devices are for people: nothing here may write to one.

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use towmag_virtual_body::fat::fat16;

use crate::common::{done, refused, text};

/// The image of an empty card with room for an hour of log, and the folder that it is in.
fn image() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("card.img");
    std::fs::write(&path, fat16(16_000).image()).unwrap();
    (folder, path)
}

#[test]
fn an_image_is_prepared_until_it_is_full() {
    let (_folder, path) = image();
    assert_eq!(done(&["card", "prepare", text(&path), "--hours", "1", "--yes"]), "TOWMAG01.BIN: 1 h, 3 MB\n");
    assert_eq!(done(&["card", "prepare", text(&path), "--hours", "1", "--yes"]), "TOWMAG02.BIN: 1 h, 3 MB\n");
    let full = refused(&["card", "prepare", text(&path), "--hours", "1", "--yes"]);
    assert!(full.contains("free"), "{full}");
}

#[test]
fn what_is_no_card_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let told = |arguments: &[&str]| refused(&[&["card"], arguments].concat());
    assert!(told(&["prepare", text(folder.path()), "--yes"]).contains("name the card itself"));
    assert!(told(&["prepare", text(&folder.path().join("none.img"))]).contains("cannot be opened"));
    let text_file = folder.path().join("notes.txt");
    std::fs::write(&text_file, "no card\n".repeat(2_000)).unwrap();
    assert!(told(&["prepare", text(&text_file), "--yes"]).contains("format the card"));
    assert!(told(&["prepare", text(&text_file), "--hours", "0", "--yes"]).contains("1 to 240"));
    let not_read = Path::new("/dev/null");
    if not_read.exists() {
        told(&["prepare", text(not_read), "--yes"]);
    }
}
