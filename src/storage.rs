//! The log's way to the card, and what the settings build.

use crate::board;
use crate::status::{Count, STATUS, Task};
use core::mem::MaybeUninit;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx, TimeSource, Timestamp};
use heapless::spsc::Consumer;
use towmag::estimate::Information;
use towmag::log::{
    AppendError, Card, Drain, Event, EventKind, FileMap, Header, InformationPart, LogFile, LogFileError, LogWriter,
    NewFile, Record, truncated,
};
use towmag::sensors::grid::Grid;
use towmag::sensors::scalar::ScalarParser;
use towmag::store::{BodySettings, Stored};
use towmag::{Pipeline, Settings};

/// Between two attempts to find a card, microseconds.
const TRY_AGAIN_US: u32 = 5_000_000;

/// Some ten epochs fill a block.
const BLOCKS_PER_HOUR: u32 = 3_600;

/// What the settings build besides the pipeline.
pub struct Built {
    pub grid: Grid,
    pub parser: ScalarParser,
}

/// Build grid and parser. Settings that were stored have been checked; should some not build, the body must nonetheless run.
pub fn build(settings: &BodySettings) -> Built {
    let built = |settings: &BodySettings| {
        let grid = settings.grid.build(settings.fluxgate.build().ok()?).ok()?;
        Some(Built { grid, parser: settings.scalar.build().ok()? })
    };
    built(settings).or_else(|| built(&BodySettings::default())).expect("the default settings are valid")
}

/// Build the pipeline where it stays.
pub fn build_pipeline(place: &'static mut MaybeUninit<Option<Pipeline>>, stored: &Stored) -> &'static mut Pipeline {
    let place = place.write(None);
    if Pipeline::start_in(place, &stored.settings.estimator, &stored.prior()).is_err() {
        _ = Pipeline::start_in(place, &Settings::default(), &stored.prior());
    }
    place.as_mut().expect("the default settings are valid")
}

/// The log header of a session that runs with this.
fn header(stored: &Stored) -> Header {
    let mut build_hash = [0; 32];
    for (place, digits) in build_hash.iter_mut().zip(env!("TOWMAG_COMMIT").as_bytes().chunks(2)) {
        let digits = core::str::from_utf8(digits).ok();
        *place = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()).unwrap_or(0);
    }
    Header {
        firmware_version: truncated(env!("CARGO_PKG_VERSION")),
        build_hash,
        settings: stored.settings.estimator,
        coefficients: stored.coefficients,
        start_tick: 0,
        start_unix_ms: None, // an event tells, once the first tick is there
    }
}

/// A card whose every block tells the watchdog that storage is at work: filling a new file takes minutes.
pub struct Alive<D>(D);

impl<D: BlockDevice> BlockDevice for Alive<D> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        STATUS.ran(Task::Storage);
        self.0.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        STATUS.ran(Task::Storage);
        self.0.write(blocks, start)
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.0.num_blocks()
    }
}

impl<D: BlockDevice> Card for Alive<D> {
    /// The card's driver returns from a write only when the card is no longer busy: all that SPI mode tells.
    fn sync(&self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The body does not know the date before it is told.
struct NoDate;

impl TimeSource for NoDate {
    fn get_timestamp(&self) -> Timestamp {
        let zero = 0;
        Timestamp {
            year_since_1970: 10,
            zero_indexed_month: zero,
            zero_indexed_day: zero,
            hours: 0,
            minutes: 0,
            seconds: 0,
        }
    }
}

// There is one of it, and it lies where it is: the small variants may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Log<D: Card> {
    Closed(D),
    Open(LogWriter<LogFile<D>>),
    /// Only while one of the others becomes the other.
    Moving,
}

/// The log on its card.
pub struct Storage<D: BlockDevice> {
    log: Log<Alive<D>>,
    header: Header,
    information: Option<Information>,
    /// Size of a new file.
    blocks: u32,
    notices: Consumer<'static, Event>,
    tried_us: Option<u32>,
}

impl<D: BlockDevice> Storage<D>
where
    D::Error: core::error::Error,
{
    pub fn new(card: D, stored: &Stored, notices: Consumer<'static, Event>) -> Self {
        let blocks = stored.settings.log_file_h * BLOCKS_PER_HOUR;
        Self {
            log: Log::Closed(Alive(card)),
            header: header(stored),
            information: stored.information,
            blocks,
            notices,
            tried_us: None,
        }
    }

    /// Write out what is queued; look for a card when there is none yet. Starts the chip anew when that is wanted.
    pub fn write(&mut self, drain: &mut Drain<'_>, now_us: u32) {
        let is_wanted = STATUS.log_is_wanted();
        if matches!(self.log, Log::Closed(_)) && is_wanted && self.is_due(now_us) {
            self.open(now_us);
        }
        if let Log::Open(writer) = &mut self.log {
            let is_last = !is_wanted || STATUS.restart_is_wanted();
            let written = write_out(writer, drain, &mut self.notices, is_last).is_ok();
            Count::LogErrors.unless(written);
            STATUS.set_log(true, !written);
            STATUS.set(Count::LogRecordsSafe, writer.durable().records);
            STATUS.set_sectors_left(writer.blocks_left());
        } else {
            STATUS.set_log(false, is_wanted);
        }
        if STATUS.restart_is_wanted() {
            board::restart();
        }
    }

    fn is_due(&self, now_us: u32) -> bool {
        self.tried_us.is_none_or(|tried_us| now_us.wrapping_sub(tried_us) >= TRY_AGAIN_US)
    }

    fn open(&mut self, now_us: u32) {
        self.tried_us = Some(now_us);
        let Log::Closed(card) = core::mem::replace(&mut self.log, Log::Moving) else { return };
        let (session, blocks) = (board::random(now_us), self.blocks);
        let found = FileMap::open_or_create(&card, NoDate, NewFile { partition: 0, blocks, nonce: session });
        self.log = match found {
            Ok(map) => {
                let mut writer = LogWriter::resume(LogFile::new(card, map), session);
                let began = begin(&mut writer, &self.header, self.information.as_ref());
                Count::LogErrors.unless(began);
                Log::Open(writer)
            }
            Err(_) => {
                Count::LogErrors.add(1);
                Log::Closed(card)
            }
        };
    }
}

type Writer<D> = LogWriter<LogFile<Alive<D>>>;

/// Move everything into the log, at the end of it with a sector that may be short.
fn write_out<D: BlockDevice>(
    writer: &mut Writer<D>,
    drain: &mut Drain<'_>,
    notices: &mut Consumer<'_, Event>,
    is_last: bool,
) -> Result<(), AppendError<LogFileError<D::Error>>> {
    drain.drain(writer)?;
    while let Some(event) = notices.peek() {
        writer.append(&Record::Event(event.clone()))?;
        notices.dequeue();
    }
    if is_last { writer.flush() } else { Ok(()) }
}

/// The records that a session begins with: what it runs with, why it started, and how the last one ended.
fn begin<D: BlockDevice>(writer: &mut Writer<D>, header: &Header, information: Option<&Information>) -> bool {
    let event = |kind| Record::Event(Event { tick: 0, kind });
    let header_written = writer.append(&Record::Header(header.clone())).is_ok();
    let told_information = information
        .into_iter()
        .flat_map(InformationPart::all)
        .all(|part| writer.append(&event(EventKind::Information(part))).is_ok());
    let last_words = board::last_words();
    let told = last_words.is_none_or(|text| writer.append(&event(EventKind::Panic(truncated(&text)))).is_ok());
    // Now, not with the first full sector: a body that panics again at once must have told why.
    header_written
        && told_information
        && writer.append(&event(EventKind::Reset(board::reset_cause()))).is_ok()
        && told
        && writer.flush().is_ok()
}
