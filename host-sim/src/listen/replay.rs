//! `host-sim listen --replay`: what was recorded, shown again at its own speed or at another.

mod recorded;
mod shown;
mod table;

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use towmag::link::FrameReader;
use towmag_live::{Mark, Sample};

use super::commands::Commands;
use super::files::at;
use super::hear::listen_and_show;
use super::notes::mark_of;
use super::options::{ListenOptions, ShowOptions};
use super::screen::Screen;
use super::session::{Session, open};
use crate::error::HostError;
use crate::message::file_name;
use crate::pace::Pace;
use crate::recording::RATE_HZ;
use recorded::Recorded;
use shown::Shown;
use table::ListenTable;

/// What to show again.
#[derive(Clone, Debug)]
pub struct ReplayOptions {
    /// What was recorded with --record or --csv, by the body, or any recording.
    pub file: PathBuf,
    /// So many times as fast as it was.
    pub speed: f64,
    /// A coefficients file, to compensate a recording with that was not.
    pub coefficients: Option<PathBuf>,
}

/// Nobody takes any.
const NO_COMMANDS: Option<&Commands<Vec<u8>>> = None;

/// So much of a file tells what it is.
const START_BYTES: u64 = 64 * 1024;

/// Show a file again, whatever it is.
pub fn replay(options: &ReplayOptions, show: &ShowOptions, screen: &mut Screen<impl Write>) -> Result<(), HostError> {
    let start = start_of(&options.file)?;
    if has_frames(&start) {
        let port = options.file.display().to_string();
        let listening = ListenOptions { port, baud: None, record: None, csv: None };
        return listen_and_show(&listening, Some(show), Some(options.speed), std::io::empty(), screen).map(drop);
    }
    let mut rows: Box<dyn Iterator<Item = Result<Shown, HostError>>> = if table::is_start(&start) {
        Box::new(ListenTable::open(&options.file)?)
    } else {
        Box::new(Recorded::open(&options.file, options.coefficients.as_deref())?)
    };
    let page = open(show, file_name(&options.file), Vec::new(), false, screen)?;
    let mut session = Session::of_page(page);
    show_rows(&mut rows, options.speed, &mut session, screen)?;
    session.end()?;
    session.stay(screen)
}

fn show_rows(
    rows: &mut dyn Iterator<Item = Result<Shown, HostError>>,
    speed: f64,
    session: &mut Session,
    screen: &mut Screen<impl Write>,
) -> Result<(), HostError> {
    let (mut pace, mut first_s, mut said_s) = (Pace::new(speed), None, f64::NEG_INFINITY);
    for row in rows {
        let Shown { sample, is_valid, notes } = row?;
        let since_s = sample.time_s - *first_s.get_or_insert(sample.time_s);
        pace.wait((since_s * RATE_HZ).round().max(0.0) as u64);
        if since_s - said_s >= 1.0 {
            said_s = since_s;
            screen.text(&line(&sample)).map_err(|source| at(None, source))?;
        }
        session.carry_out(NO_COMMANDS, screen)?;
        let Some(page) = &mut session.page else { continue };
        page.row(sample, is_valid);
        notes.iter().filter_map(|note| mark_of(note)).for_each(|mark: Mark| page.recorded_mark(mark));
    }
    Ok(())
}

fn line(sample: &Sample) -> String {
    let number =
        |value: Option<f64>, digits: usize| value.map_or_else(|| "-".into(), |value| format!("{value:.digits$}"));
    let Sample { time_s, raw_nt, compensated_nt, residual_nt, depth_m, .. } = *sample;
    format!(
        "{time_s:.1} s: raw {} nT, compensated {} nT, residual {} nT, depth {} m",
        number(raw_nt, 3),
        number(compensated_nt, 3),
        number(residual_nt, 3),
        number(depth_m, 2)
    )
}

fn start_of(path: &Path) -> Result<Vec<u8>, HostError> {
    let mut start = Vec::new();
    let file = File::open(path).and_then(|file| file.take(START_BYTES).read_to_end(&mut start));
    file.map_err(|source| HostError::Usage(format!("{}: cannot be read: {source}", path.display())))?;
    Ok(start)
}

/// Whether these are bytes of the cable: no other file has a whole frame in it but by a chance of one in four thousand
/// million, each.
fn has_frames(start: &[u8]) -> bool {
    let mut frames = FrameReader::default();
    start.iter().for_each(|&byte| _ = frames.push(byte));
    frames.counters().good > 0
}
