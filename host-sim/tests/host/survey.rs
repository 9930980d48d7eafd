//! `host-sim survey` as a user runs it: its files, what it refuses, and other programs that open its map.

mod base;
mod faults;
mod files;
mod input;
mod readers;
mod tow;
