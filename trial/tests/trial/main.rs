//! The blind trial, as one program.
#![cfg(not(target_os = "none"))]

mod blind;
mod drawn;
mod independence;
mod own_effects;
mod parts;
