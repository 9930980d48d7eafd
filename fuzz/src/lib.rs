//! What is fuzzed: everything that takes bytes from outside.

pub mod importer;
pub mod targets;
