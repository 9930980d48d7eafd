//! `host-sim recover`: everything that a damaged or unclosed card still holds.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;
use towmag::log::{Event, EventKind, Record, Records, Recovered, Survey};

use super::inputs::keep_inputs;
use crate::error::HostError;
use crate::output::OutputDir;
use crate::recording::{
    DeviceLogReader, FileBlocks, RecordingError, RecordingReader, RecordingRow, SessionGap, survey,
};
use crate::summary::to_json;

const RESULTS: [&str; 3] = ["recording.csv", "events.txt", "summary.json"];

/// What was found on a card.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RecoverResult {
    /// Format of the file.
    pub schema: u32,
    /// Intact sectors of the log, each copy counted.
    pub sectors: usize,
    /// Of these, copies of another one: the body writes each sector twice.
    pub duplicates: usize,
    /// Blocks that once were sectors and are damaged.
    pub damaged_blocks: usize,
    /// Blocks that the card does not give back.
    pub unreadable_blocks: usize,
    /// Sectors that are known to be missing between others.
    pub missing_sectors: u64,
    /// Starts of the firmware.
    pub sessions: u64,
    /// Epochs in `recording.csv`.
    pub epochs: u64,
    /// Epochs that the firmware itself reported as lost.
    pub epochs_reported_lost: u64,
    /// Other records, in `events.txt`.
    pub events: u64,
    /// What lies between the sessions, in their order.
    pub session_gaps: Vec<SessionGap>,
}

/// Recover all records of a card, card image or log file, without trusting its file system.
pub fn recover(image: &Path, out: &Path) -> Result<RecoverResult, HostError> {
    keep_inputs(&[image], out, &RESULTS)?;
    let io = |source| RecordingError::Io { path: image.display().to_string(), source };
    let mut source = FileBlocks::open(image).map_err(io)?;
    let (keys, found) = survey(&mut source);
    if keys.is_empty() {
        return Err(HostError::NotEnough(format!(
            "{}: holds no intact sector of a log: is it the whole card, or the file TOWMAGnn.BIN from it?",
            image.display()
        )));
    }
    let output = OutputDir::create(out)?;
    let mut result = counted(&found);
    let mut log = DeviceLogReader::open(image)?;
    let events = events(Records::new(&mut source, log.sectors()), log.session_gaps(), &mut result);
    result.session_gaps = log.session_gaps().to_vec();
    output.write("events.txt", events)?;
    result.epochs = write_recording(&mut log, &output)?;
    output.write("summary.json", to_json(&result))?;
    output.commit("summary.json")?;
    Ok(result)
}

fn counted(found: &Survey) -> RecoverResult {
    RecoverResult {
        schema: 1,
        sectors: found.sectors,
        duplicates: found.duplicates,
        damaged_blocks: found.damaged,
        unreadable_blocks: found.unreadable,
        ..RecoverResult::default()
    }
}

/// Everything but the epochs and where and how the body was, a line each.
fn events(records: impl Iterator<Item = Recovered>, gaps: &[SessionGap], result: &mut RecoverResult) -> String {
    let mut text = String::new();
    let mut gaps = gaps.iter().peekable();
    for item in records {
        let line = match item {
            // In `recording.csv`.
            Recovered::Record(
                Record::Epoch(_)
                | Record::Event(Event { kind: EventKind::Navigation(_) | EventKind::Housekeeping(_), .. }),
            ) => continue,
            Recovered::Session(id) => {
                result.sessions += 1;
                let session = format!("{:08x}", id.session);
                let gap = gaps.next_if(|gap| gap.session == session);
                let gap = gap.map(|gap| format!("\n{gap}")).unwrap_or_default();
                format!("session {session} in file {}{gap}", id.file_number)
            }
            Recovered::Missing { sectors } => {
                result.missing_sectors += u64::from(sectors);
                format!("{sectors} sectors are missing here")
            }
            Recovered::SectorLost(key) => format!("the sector in block {} was lost while reading", key.position),
            Recovered::Unreadable(error) => format!("a record cannot be read: {error:?}"),
            Recovered::Record(Record::Header(header)) => format!("tick {}: {header:?}", header.start_tick),
            Recovered::Record(Record::Event(event)) => format!("tick {}: {:?}", event.tick, event.kind),
            Recovered::Record(Record::Loss(loss)) => {
                result.epochs_reported_lost += u64::from(loss.epochs);
                format!("tick {}: {} epochs and {} other records lost", loss.first_tick, loss.epochs, loss.others)
            }
        };
        result.events += 1;
        writeln!(text, "{line}").expect("a string takes it");
    }
    text
}

/// The epochs as a recording that the other commands read. How many there are.
fn write_recording(log: &mut DeviceLogReader, output: &OutputDir) -> Result<u64, HostError> {
    let columns: Vec<usize> = (0..log.schema().len()).collect();
    let mut csv = csv::Writer::from_writer(output.create_file("recording.csv")?);
    csv.write_record(log.schema().names())?;
    let (mut row, mut epochs) = (RecordingRow::default(), 0);
    loop {
        match log.read_row(&mut row) {
            Ok(true) => {
                log.write_fields(&row, &columns, &mut |field| csv.write_field(field))?;
                csv.write_record(None::<&[u8]>)?;
            }
            // A log without a single epoch is still a log.
            Ok(false) | Err(RecordingError::Bad { .. }) => break,
            Err(error) => return Err(error.into()),
        }
        epochs += 1;
    }
    let file = csv.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))?;
    file.finish()?;
    Ok(epochs)
}
