//! Other people's files, as one program.
#![cfg(not(target_os = "none"))]

mod corpus;
mod foreign_text;
mod fuzz_corpora;
mod hostile_files;
mod hostile_text;
