//! What is fuzzed: everything that takes bytes from outside.

#[cfg(feature = "effects")]
pub mod effect_file;
#[cfg(feature = "importer")]
pub mod importer;
pub mod targets;
