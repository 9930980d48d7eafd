//! The log's way to the card.
//!
//! A body without a card, or with one that comes and goes, does everything else as ever. While the card is away, records
//! wait in their queue; those that find no room there are counted, and the log tells of them in their place. The card is
//! looked for again after 1, 2, 4 and then every 8 s. A card that is back goes on with the same session; the sector that
//! was being filled waits here, on whichever card comes next.

use crate::body::Firmware;
use crate::estimate::Prior;
use crate::hardware::{CardSlot, Stamp, System};
use crate::health::{Count, Health, Task};
use crate::log::{
    AppendError, BlockSource as _, Event, EventKind, FileMap, Header, InformationPart, LogFile, LogFileError, NewFile,
    Ready, Record, RecordConsumer, SectorWriter, truncated,
};
use crate::store::Stored;
use embedded_sdmmc::BlockDevice as _;
use heapless::spsc::Consumer;
use next_file::NextFile;
use pauses::Pauses;
use watched::WatchedCard;

mod next_file;
mod pauses;
mod watched;

/// Some ten epochs fill a sector, which is written to two blocks.
pub const BLOCKS_PER_HOUR: u32 = 2 * 3_600;

/// A step that marks blocks or makes a file ends after this, microseconds; records are written after each step.
const STEP_US: u32 = 100_000;

/// The next file is begun when the present one has room for no more sectors than this, of ten minutes.
const LAST_SECTORS: u32 = 600;

/// Cards come with one.
pub const PARTITION: usize = 0;

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

type Writer<'a, D, S> = SectorWriter<LogFile<WatchedCard<'a, D, S>>>;

// There is one of it, and it lies where it is: the small variants may waste the space of the large one.
#[allow(clippy::large_enum_variant)]
enum Log<'a, D: CardSlot, S: System> {
    /// No card has been found since the start.
    Closed(WatchedCard<'a, D, S>),
    /// The card works.
    Open(Writer<'a, D, S>),
    /// The card has failed; the session waits for it, or for another one.
    Suspended(Writer<'a, D, S>),
    /// Only while one of the others becomes the other.
    Moving,
}

impl<'a, D: CardSlot, S: System> Log<'a, D, S> {
    /// Whether it is the log that waits for this file.
    fn is_of(&self, map: &FileMap) -> bool {
        matches!(self, Self::Suspended(writer) if writer.device().map() == map)
    }

    fn card(&self) -> Option<&WatchedCard<'a, D, S>> {
        match self {
            Self::Closed(card) => Some(card),
            Self::Open(writer) | Self::Suspended(writer) => Some(writer.device().card()),
            Self::Moving => None,
        }
    }
}

/// The ends of the queues at the card.
pub struct StorageInput<'a> {
    /// Records of the epochs.
    pub records: RecordConsumer<'a>,
    /// Events that are too long for the queue of the records.
    pub notices: Consumer<'a, Event>,
}

/// The log on its card.
pub struct Storage<'a, D: CardSlot, S: System> {
    log: Log<'a, D, S>,
    input: StorageInput<'a>,
    header: Header,
    prior: Prior,
    /// Size of a new file.
    blocks: u32,
    next: NextFile,
    /// Number of the file that is full: those up to it are not gone on with.
    full: u16,
    pauses: Pauses,
    health: &'a Health,
    system: S,
}

impl<'a, D: CardSlot, S: System> Storage<'a, D, S>
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
            log: Log::Closed(WatchedCard { card, health, system: system.clone() }),
            input,
            header: header(stored, firmware),
            prior: stored.prior(),
            blocks: stored.settings.log_file_h * BLOCKS_PER_HOUR,
            next: NextFile::default(),
            full: 0,
            pauses: Pauses::default(),
            health,
            system,
        }
    }

    /// Write out what is queued; look for a card when there is none. Starts the chip anew when that is wanted.
    pub fn run(&mut self) {
        let is_wanted = self.health.log.is_wanted();
        if is_wanted && !matches!(self.log, Log::Open(_)) {
            self.look_for_card();
        }
        if !self.write_out(is_wanted) || !self.prepare() {
            self.suspend();
        }
        let is_open = matches!(self.log, Log::Open(_));
        self.health.log.set(is_open, is_wanted && !is_open && !self.next.is_making());
        if self.health.restart_is_wanted() {
            self.system.restart();
        }
        self.health.tasks.ran(Task::Storage);
    }

    /// The records that are queued; false when the card has failed.
    fn write_out(&mut self, is_wanted: bool) -> bool {
        let Log::Open(writer) = &mut self.log else { return true };
        let is_last = !is_wanted || self.health.restart_is_wanted();
        let written = write_out(writer, &mut self.input, is_last);
        let file = writer.device();
        let (number, is_marked) = (file.map().region().file_number, file.is_marked());
        self.health.counts.set(Count::LogRecordsSafe, writer.durable().records);
        self.health.log.set_sectors_left(sectors_left(writer));
        match written {
            Ok(()) => true,
            // More places are marked soon; and behind those that are in use the next call looks further.
            Err(AppendError::Full) if !is_marked => true,
            Err(AppendError::InUse) => true,
            Err(AppendError::Full) => {
                self.full = number;
                let Some(ready) = self.next.take() else { return false };
                self.begin_on(ready);
                self.write_out(is_wanted)
            }
            Err(_) => false,
        }
    }

    /// Mark blocks of the present file; towards its end, go on making the next. False when the card has failed and there is
    /// no room without.
    fn prepare(&mut self) -> bool {
        let Log::Open(writer) = &mut self.log else { return true };
        let begin_us = self.system.now_us();
        let is_over = |system: &S| system.now_us().wrapping_sub(begin_us) >= STEP_US;
        while !writer.device().is_marked() && !is_over(&self.system) {
            if writer.device_mut().mark().is_err() {
                self.health.counts.add(Count::LogErrors, 1);
                return writer.blocks_left() > 0;
            }
        }
        if self.next.is_making() {
            if let Log::Open(writer) = &self.log
                && self.next.step(writer.device().card()).is_err()
            {
                self.fail_next();
            }
        } else if sectors_left(writer) <= LAST_SECTORS.min(writer.device().map().places() / 2)
            && self.next.is_to_begin(begin_us)
        {
            self.begin_next();
        }
        true
    }

    /// Wait for the card, or for another one.
    fn suspend(&mut self) {
        self.fail();
        self.log = match core::mem::replace(&mut self.log, Log::Moving) {
            Log::Open(writer) => Log::Suspended(writer),
            log => log,
        };
    }

    fn fail(&mut self) {
        self.health.counts.add(Count::LogErrors, 1);
        self.health.log.set_no_log();
        self.health.checks.set_card_blocks(0);
        self.next.forget();
        self.pauses.grow(self.system.now_us());
    }

    fn fail_next(&mut self) {
        self.health.counts.add(Count::LogErrors, 1);
        self.next.fail(self.system.now_us());
    }

    /// Look for a card and a file on it, or go on making one. At once, if it can be: a body that panics again and again must
    /// get so far as to tell why.
    fn look_for_card(&mut self) {
        let begin_us = self.system.stamp_us(Stamp::Other);
        if !self.next.is_making() && self.pauses.are_over(begin_us) {
            self.find_file();
        }
        while self.next.is_making() && self.system.now_us().wrapping_sub(begin_us) < STEP_US {
            let Some(card) = self.log.card() else { return };
            if self.next.step(card).is_err() {
                return self.fail();
            }
        }
        if let Some(ready) = self.next.take() {
            self.begin_on(ready);
        }
    }

    fn find_file(&mut self) {
        let Some(card) = self.log.card() else { return };
        card.look_again();
        let new = self.new_file();
        let begun = match FileMap::open_newest(card, PARTITION, self.full) {
            Ok(Some(map)) if self.log.is_of(&map) => return self.begin_on(Ready { map, is_new: false }),
            found => found.and_then(|found| self.next.begin(card, found, new)),
        };
        if begun.is_err() {
            self.fail();
        }
    }

    /// One that was prepared, or a new one.
    fn begin_next(&mut self) {
        let Log::Open(writer) = &self.log else { return };
        let (card, present) = (writer.device().card(), writer.device().map().region().file_number);
        let new = self.new_file();
        let found = FileMap::open_newest(card, PARTITION, present);
        if found.and_then(|found| self.next.begin(card, found, new)).is_err() {
            self.fail_next();
        }
    }

    fn new_file(&self) -> NewFile {
        NewFile { partition: PARTITION, blocks: self.blocks, nonce: self.number() }
    }

    fn number(&self) -> u32 {
        self.system.random(self.system.stamp_us(Stamp::Other))
    }

    /// Log in this file: on with the session if there is one, else with a new one.
    fn begin_on(&mut self, Ready { map, is_new }: Ready) {
        let make = |card| {
            let mut file = if is_new { LogFile::of_new(card, map) } else { LogFile::new(card, map) };
            // The log needs the first places now. Should it fail, the first write does as well.
            let _ = file.mark();
            file
        };
        let (mut writer, is_begun) = match core::mem::replace(&mut self.log, Log::Moving) {
            Log::Closed(card) => {
                let mut writer = SectorWriter::resume(make(card), self.number());
                writer.distinguish();
                (writer, false)
            }
            Log::Open(mut writer) | Log::Suspended(mut writer) if *writer.device().map() == map => {
                writer.device_mut().look_again();
                writer.look_again();
                (writer, true)
            }
            Log::Open(writer) | Log::Suspended(writer) => (writer.move_to(|file| make(file.into_card())), false),
            Log::Moving => return,
        };
        let begun = is_begun || self.begin(&mut writer);
        self.log = Log::Open(writer);
        if !begun {
            return self.suspend();
        }
        self.pauses.end();
        let blocks = self.log.card().and_then(|card| card.num_blocks().ok());
        self.health.checks.set_card_blocks(blocks.map_or(0, |blocks| blocks.0));
    }

    /// Write the records that a session begins with: what it runs with, why it started, and how the last one ended.
    fn begin(&self, writer: &mut Writer<'a, D, S>) -> bool {
        let event = |kind| Record::Event(Event { tick: 0, kind });
        let header_written = writer.append(&Record::Header(self.header.clone())).is_ok();
        let Prior { information, level, .. } = &self.prior;
        let information = information.iter().flat_map(InformationPart::all).map(EventKind::Information);
        let level = level.iter().flat_map(InformationPart::all).map(EventKind::Level);
        let information_written = information.chain(level).all(|kind| writer.append(&event(kind)).is_ok());
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

/// Room for so many sectors, marked or not yet.
fn sectors_left<D: CardSlot, S: System>(writer: &Writer<'_, D, S>) -> u32 {
    let file = writer.device();
    writer.blocks_left() + file.map().places() - file.blocks()
}

/// Move everything into the log, at the end of it with a sector that may be short.
fn write_out<D: CardSlot, S: System>(
    writer: &mut Writer<'_, D, S>,
    input: &mut StorageInput<'_>,
    is_last: bool,
) -> Result<(), AppendError<LogFileError<D::Error>>> {
    writer.take_up()?;
    input.records.drain(writer)?;
    while let Some(event) = input.notices.peek() {
        writer.append(&Record::Event(event.clone()))?;
        input.notices.dequeue();
    }
    if is_last { writer.flush() } else { Ok(()) }
}
