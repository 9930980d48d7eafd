//! The log's way to the card.

use crate::body::Firmware;
use crate::estimate::Information;
use crate::hardware::{Stamp, System};
use crate::health::{Count, Health, Task};
use crate::log::{
    AppendError, Card, Event, EventKind, FileMap, Header, InformationPart, LogFile, LogFileError, NewFile, Record,
    RecordConsumer, SectorWriter, truncated,
};
use crate::store::Stored;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx, TimeSource, Timestamp};
use heapless::spsc::Consumer;

/// Between two attempts to find a card, microseconds.
const TRY_AGAIN_US: u32 = 5_000_000;

/// Some ten epochs fill a block.
const BLOCKS_PER_HOUR: u32 = 3_600;

/// The log header of a session that runs with this.
fn header(stored: &Stored, firmware: &Firmware) -> Header {
    Header {
        firmware_version: truncated(firmware.version),
        build_hash: firmware.build_hash(),
        settings: stored.settings.estimator,
        coefficients: stored.coefficients,
        start_tick: 0,
        start_unix_ms: None, // an event tells, once the first tick is there
    }
}

/// A card whose every block tells the watchdog that storage is at work: filling a new file takes minutes.
struct WatchedCard<'a, D> {
    card: D,
    health: &'a Health,
}

impl<D: BlockDevice> BlockDevice for WatchedCard<'_, D> {
    type Error = D::Error;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.health.tasks.ran(Task::Storage);
        self.card.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), Self::Error> {
        self.health.tasks.ran(Task::Storage);
        self.card.write(blocks, start)
    }

    fn num_blocks(&self) -> Result<BlockCount, Self::Error> {
        self.card.num_blocks()
    }
}

impl<D: BlockDevice> Card for WatchedCard<'_, D> {
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

type Writer<'a, D> = SectorWriter<LogFile<WatchedCard<'a, D>>>;

// There is one of it, and it lies where it is: the small variants may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Log<'a, D: BlockDevice> {
    Closed(WatchedCard<'a, D>),
    Open(Writer<'a, D>),
    /// Only while one of the others becomes the other.
    Moving,
}

/// The ends of the queues at the card.
pub struct StorageInput<'a> {
    /// Records of the epochs.
    pub records: RecordConsumer<'a>,
    /// Events that are too long for the queue of the records.
    pub notices: Consumer<'a, Event>,
}

/// The log on its card.
pub struct Storage<'a, D: BlockDevice, S> {
    log: Log<'a, D>,
    input: StorageInput<'a>,
    header: Header,
    information: Option<Information>,
    /// Size of a new file.
    blocks: u32,
    tried_us: Option<u32>,
    health: &'a Health,
    system: S,
}

impl<'a, D: BlockDevice, S: System> Storage<'a, D, S>
where
    D::Error: core::error::Error,
{
    /// A card that has not been looked at yet.
    pub fn new(
        card: D,
        input: StorageInput<'a>,
        stored: &Stored,
        firmware: &Firmware,
        health: &'a Health,
        system: S,
    ) -> Self {
        Self {
            log: Log::Closed(WatchedCard { card, health }),
            input,
            header: header(stored, firmware),
            information: stored.information,
            blocks: stored.settings.log_file_h * BLOCKS_PER_HOUR,
            tried_us: None,
            health,
            system,
        }
    }

    /// Write out what is queued; look for a card when there is none yet. Starts the chip anew when that is wanted.
    pub fn run(&mut self) {
        let now_us = self.system.stamp_us(Stamp::Other);
        let is_wanted = self.health.log.is_wanted();
        if matches!(self.log, Log::Closed(_)) && is_wanted && self.is_due(now_us) {
            self.open(now_us);
        }
        if let Log::Open(writer) = &mut self.log {
            let is_last = !is_wanted || self.health.restart_is_wanted();
            let written = write_out(writer, &mut self.input, is_last).is_ok();
            self.health.counts.add_if(!written, Count::LogErrors);
            self.health.log.set(true, !written);
            self.health.counts.set(Count::LogRecordsSafe, writer.durable().records);
            self.health.log.set_sectors_left(writer.blocks_left());
        } else {
            self.health.log.set(false, is_wanted);
        }
        if self.health.restart_is_wanted() {
            self.system.restart();
        }
        self.health.tasks.ran(Task::Storage);
    }

    fn is_due(&self, now_us: u32) -> bool {
        self.tried_us.is_none_or(|tried_us| now_us.wrapping_sub(tried_us) >= TRY_AGAIN_US)
    }

    fn open(&mut self, now_us: u32) {
        self.tried_us = Some(now_us);
        let Log::Closed(card) = core::mem::replace(&mut self.log, Log::Moving) else { return };
        let (session, blocks) = (self.system.random(now_us), self.blocks);
        let found = FileMap::open_or_create(&card, NoDate, NewFile { partition: 0, blocks, nonce: session });
        self.log = match found {
            Ok(map) => {
                let mut writer = SectorWriter::resume(LogFile::new(card, map), session);
                self.health.counts.add_if(!self.begin(&mut writer), Count::LogErrors);
                Log::Open(writer)
            }
            Err(_) => {
                self.health.counts.add(Count::LogErrors, 1);
                Log::Closed(card)
            }
        };
    }

    /// Write the records that a session begins with: what it runs with, why it started, and how the last one ended.
    fn begin(&self, writer: &mut Writer<'a, D>) -> bool {
        let event = |kind| Record::Event(Event { tick: 0, kind });
        let header_written = writer.append(&Record::Header(self.header.clone())).is_ok();
        let information = self.information.iter().flat_map(InformationPart::all);
        let information_written =
            information.map(|part| writer.append(&event(EventKind::Information(part)))).all(|written| written.is_ok());
        let last_words = self.system.last_words();
        let last_words_written =
            last_words.is_none_or(|text| writer.append(&event(EventKind::Panic(truncated(&text)))).is_ok());
        // Now, not with the first full sector: a body that panics again at once must have told why.
        header_written
            && information_written
            && writer.append(&event(EventKind::Reset(self.system.reset_cause()))).is_ok()
            && last_words_written
            && writer.flush().is_ok()
    }
}

/// Move everything into the log, at the end of it with a sector that may be short.
fn write_out<D: BlockDevice>(
    writer: &mut Writer<'_, D>,
    input: &mut StorageInput<'_>,
    is_last: bool,
) -> Result<(), AppendError<LogFileError<D::Error>>> {
    input.records.drain(writer)?;
    while let Some(event) = input.notices.peek() {
        writer.append(&Record::Event(event.clone()))?;
        input.notices.dequeue();
    }
    if is_last { writer.flush() } else { Ok(()) }
}
