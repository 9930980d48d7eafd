//! The Python of the tests that need one.

use std::ffi::OsString;
use std::process::Command;

/// The Python that is asked for, else the one of the path.
pub(crate) fn python() -> OsString {
    std::env::var_os("TOWMAG_PYTHON").unwrap_or("python3".into())
}

/// Whether it can import some modules, which a requirements file names; one that was asked for must.
pub(crate) fn has_python(modules: &str, requirements: &str) -> bool {
    let tried = Command::new(python()).args(["-c", &format!("import {modules}")]).output();
    let has = tried.is_ok_and(|output| output.status.success());
    assert!(
        has || std::env::var_os("TOWMAG_PYTHON").is_none(),
        "the Python of TOWMAG_PYTHON lacks what {requirements} names"
    );
    if !has {
        eprintln!("skipped: needs python3 with what {requirements} names");
    }
    has
}
