//! What is printed for a person, unless nobody wants to read it.

use std::fmt::Display;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether only warnings and errors are wanted.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// From now on print nothing but warnings, errors and what was asked for by name.
pub(super) fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
    host_sim::show_no_progress();
}

/// A line on standard output, unless quiet.
pub(super) fn say(line: impl Display) {
    if !IS_QUIET.load(Ordering::Relaxed) {
        print(format_args!("{line}\n"));
    }
}

/// A line on standard error, unless quiet.
pub(super) fn say_aside(line: impl Display) {
    if !IS_QUIET.load(Ordering::Relaxed) {
        eprintln!("{line}");
    }
}

/// Text on standard output, quiet or not.
pub(super) fn print(text: impl Display) {
    // Nobody is left to tell when whoever read it has gone: `| head` is no failure.
    let _gone = write!(io::stdout(), "{text}");
}

/// Sentences that the reader must know before trusting a result, on standard error.
pub(super) fn warn(sentences: &[String]) {
    sentences.iter().for_each(|sentence| eprintln!("warning: {sentence}"));
}
