//! The repository's own chores. `cargo xtask --help` says which; the rules of its structure are tested in `tests/`.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(not(target_os = "none"))]
pub mod documents;
#[cfg(not(target_os = "none"))]
pub mod image;
#[cfg(not(target_os = "none"))]
pub mod measured;
#[cfg(not(target_os = "none"))]
pub mod picture;
#[cfg(not(target_os = "none"))]
pub mod repository;
#[cfg(not(target_os = "none"))]
pub mod shape;
#[cfg(not(target_os = "none"))]
pub mod structure;
