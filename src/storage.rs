//! The log's way to the card, and what the settings build.

use crate::board;
use crate::status::{Count, STATUS, Task};
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx, TimeSource, Timestamp};
use towmag::Pipeline;
use towmag::logbook::{Card, Drain, Event, EventKind, FileMap, LogFile, LogWriter, NewFile, Record, truncated};
use towmag::sensors::grid::Grid;
use towmag::sensors::scalar::ScalarParser;
use towmag::setup::Setup;

/// Between two attempts to find a card, microseconds.
const TRY_AGAIN_US: u32 = 5_000_000;

/// What the settings build.
pub struct Built {
    pub pipeline: Pipeline,
    pub grid: Grid,
    pub parser: ScalarParser,
}

/// Build everything. A set-up that was stored has been checked; should one not build, the body must nonetheless run.
pub fn build(setup: &Setup) -> Built {
    build_from(setup).or_else(|| build_from(&Setup::default())).expect("the default settings are valid")
}

fn build_from(setup: &Setup) -> Option<Built> {
    Some(Built {
        pipeline: Pipeline::new(&setup.settings, setup.coefficients).ok()?,
        grid: setup.grid.build(setup.fluxgate.build().ok()?).ok()?,
        parser: setup.scalar.build().ok()?,
    })
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
    setup: Setup,
    tried_us: Option<u32>,
}

impl<D: BlockDevice> Storage<D>
where
    D::Error: core::error::Error,
{
    pub fn new(card: D, setup: Setup) -> Self {
        Self { log: Log::Closed(Alive(card)), setup, tried_us: None }
    }

    /// Write out what is queued; look for a card when there is none yet.
    pub fn write(&mut self, drain: &mut Drain<'_>, now_us: u32) {
        if matches!(self.log, Log::Closed(_)) && self.is_due(now_us) {
            self.open(now_us);
        }
        let Log::Open(writer) = &mut self.log else { return STATUS.set_log(false, true) };
        let drained = drain.drain(writer).is_ok();
        Count::LogErrors.unless(drained);
        STATUS.set_log(true, !drained);
        STATUS.set(Count::LogRecordsSafe, writer.durable().records);
    }

    fn is_due(&self, now_us: u32) -> bool {
        self.tried_us.is_none_or(|tried_us| now_us.wrapping_sub(tried_us) >= TRY_AGAIN_US)
    }

    fn open(&mut self, now_us: u32) {
        self.tried_us = Some(now_us);
        let Log::Closed(card) = core::mem::replace(&mut self.log, Log::Moving) else { return };
        let (session, blocks) = (board::random(now_us), self.setup.log_blocks);
        let found = FileMap::open_or_create(&card, NoDate, NewFile { partition: 0, blocks, nonce: session });
        self.log = match found {
            Ok(map) => {
                let mut writer = LogWriter::resume(LogFile::new(card, map), session);
                let began = self.begin(&mut writer);
                Count::LogErrors.unless(began);
                Log::Open(writer)
            }
            Err(_) => {
                Count::LogErrors.add(1);
                Log::Closed(card)
            }
        };
    }

    /// The records that a session begins with: what it runs with, why it started, and how the last one ended.
    fn begin(&self, writer: &mut LogWriter<LogFile<Alive<D>>>) -> bool {
        let mut header = self.setup.header(env!("CARGO_PKG_VERSION"));
        for (place, digit) in header.build_hash.iter_mut().zip(env!("TOWMAG_COMMIT").as_bytes().chunks(2)) {
            *place =
                core::str::from_utf8(digit).ok().and_then(|digits| u8::from_str_radix(digits, 16).ok()).unwrap_or(0);
        }
        let event = |kind| Record::Event(Event { tick: 0, kind });
        let header_written = writer.append(&Record::Header(header)).is_ok();
        let last_words = board::last_words();
        let told = last_words.is_none_or(|text| writer.append(&event(EventKind::Panic(truncated(&text)))).is_ok());
        // Now, not with the first full sector: a body that panics again at once must have told why.
        header_written
            && writer.append(&event(EventKind::Reset(board::reset_cause()))).is_ok()
            && told
            && writer.flush().is_ok()
    }
}
