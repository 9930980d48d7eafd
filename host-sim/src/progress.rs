//! How far a command is, on stderr where that is a terminal: the bytes of a recording, cheap enough for every row, or stages.

use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::recording::RecordingReader;

/// Whether nobody wants to see any bar.
static IS_HIDDEN: AtomicBool = AtomicBool::new(false);

/// From now on show no progress.
pub fn show_no_progress() {
    IS_HIDDEN.store(true, Ordering::Relaxed);
}

/// The bar, or one that nobody sees.
fn shown(bar: ProgressBar) -> ProgressBar {
    if IS_HIDDEN.load(Ordering::Relaxed) {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar
}

/// Rows between two looks at the bar.
const ROWS_PER_UPDATE: u64 = 4096;

/// A bar on stderr; nothing at all where stderr is no terminal.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// For reading a recording from its start.
    pub(crate) fn of(recording: &dyn RecordingReader) -> Self {
        let Some(byte_len) = recording.byte_len() else { return Self(shown(ProgressBar::new_spinner())) };
        let template = "{prefix} [{bar:40}] {percent:>3} % {binary_bytes_per_sec}, {eta} left";
        let style = ProgressStyle::with_template(template).expect("a constant template");
        let bar = shown(ProgressBar::new(byte_len)).with_style(style.progress_chars("=> "));
        bar.set_prefix(recording.file().to_string());
        Self(bar)
    }

    /// Tell how far it is; `rows` have been read.
    pub(crate) fn update(&self, recording: &dyn RecordingReader, rows: u64) {
        if rows.is_multiple_of(ROWS_PER_UPDATE) {
            self.0.set_position(recording.bytes_read());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// A bar over things that are done one by one, in any order and by several threads.
pub(crate) struct Counter(ProgressBar);

impl Counter {
    /// For `count` things; `what` is being done to them.
    pub(crate) fn new(count: usize, what: &'static str) -> Self {
        let style = ProgressStyle::with_template("{prefix} [{bar:40}] {pos} of {len}, {eta} left");
        let style = style.expect("a constant template").progress_chars("=> ");
        let bar = shown(ProgressBar::new(count as u64)).with_style(style);
        bar.set_prefix(what);
        Self(bar)
    }

    /// One more is done.
    pub(crate) fn add_one(&self) {
        self.0.inc(1);
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// A bar over each part of the work on a card, in bytes or in sectors.
pub(crate) struct CardBar(ProgressBar);

impl CardBar {
    /// Before the first part.
    pub(crate) fn new() -> Self {
        let style = ProgressStyle::with_template("{prefix} [{bar:40}] {percent:>3} %, {eta} left");
        let style = style.expect("a constant template").progress_chars("=> ");
        Self(shown(ProgressBar::new(0)).with_style(style))
    }
}

impl towmag_card::Progress for CardBar {
    fn begin(&self, what: &'static str, bytes: u64) {
        self.0.set_prefix(what);
        self.0.set_length(bytes);
        self.0.reset();
    }

    fn add(&self, bytes: u64) {
        self.0.inc(bytes);
    }
}

impl Drop for CardBar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Between two pictures of a stage that lasts.
const TICK: Duration = Duration::from_millis(200);

/// What is being done and for how long: for work of which nobody knows beforehand how long its parts take.
pub(crate) struct Stages(ProgressBar);

impl Stages {
    /// Before the first.
    pub(crate) fn new() -> Self {
        let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})").expect("a constant template");
        let spinner = shown(ProgressBar::new_spinner()).with_style(style);
        spinner.enable_steady_tick(TICK);
        Self(spinner)
    }

    /// The next begins.
    pub(crate) fn begin(&self, stage: impl Display) {
        self.0.set_message(stage.to_string());
    }
}

impl Drop for Stages {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
