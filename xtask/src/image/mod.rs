//! What can be proved of the firmware's image as it is linked: which functions can panic, and how deep the stack can get.
//!
//! The linker leaves its relocations in the image (`build.rs`), and they say which function calls which.

mod calls;
mod panics;
mod stack;
mod thumb;

pub use panics::check as check_panics;
pub use stack::report as report_stack;

use anyhow::Context;
use std::path::PathBuf;

use crate::repository;
use calls::Image;

/// The image that `cargo fw` makes.
fn image() -> anyhow::Result<Image> {
    let path: PathBuf = repository::target_folder().join("thumbv7em-none-eabihf/firmware/firmware");
    let bytes = std::fs::read(&path).with_context(|| format!("{}: run `cargo fw` first", path.display()))?;
    Image::read(&bytes)
}
