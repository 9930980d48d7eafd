//! `host-sim survey` as a user runs it: its files, what it refuses, and other programs that open its map.

mod common;
#[path = "survey/faults.rs"]
mod faults;
#[path = "survey/files.rs"]
mod files;
#[path = "survey/input.rs"]
mod input;
#[path = "survey/readers.rs"]
mod readers;
#[path = "survey/tow.rs"]
mod tow;
