//! The task of the storage on a card that is watched at every write: what would be on it if the power went now, and what
//! had been acknowledged by then.

use crate::bare_chip::BareChip;
use crate::disk::{Disk, DiskError};
use crate::log::epoch;
use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::rc::Rc;
use towmag::body::Firmware;
use towmag::hardware::CardSlot;
use towmag::health::{Count, Health};
use towmag::log::{Card, Event, RecordConsumer, RecordProducer, RecordQueue};
use towmag::storage::{Storage, StorageInput};
use towmag::store::Stored;

const FIRMWARE: Firmware = Firmware { version: "0.1.0-test", commit: "5a5a" };

/// Records that a session begins each file with: header and reason of the start.
const RECORDS_OF_BEGINNING: u32 = 2;

/// A block that is written takes so long, microseconds.
const BLOCK_US: u32 = 1_000;

/// The card just before a block is written.
pub struct Moment {
    pub disk: Disk,
    pub index: u32,
    pub new: [u8; 512],
    /// Epochs that the body has been told are safe.
    pub safe: Range<u32>,
}

/// A card that keeps what it was at each of its first writes.
pub struct WatchedDisk {
    disk: Rc<Disk>,
    safe: Rc<RefCell<Range<u32>>>,
    moments: Rc<RefCell<Vec<Moment>>>,
    most_moments: usize,
    clock: Clock,
}

impl BlockDevice for WatchedDisk {
    type Error = DiskError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), DiskError> {
        self.disk.read(blocks, start)
    }

    fn write(&self, blocks: &[Block], start: BlockIdx) -> Result<(), DiskError> {
        self.clock.pass(BLOCK_US * blocks.len() as u32);
        for (block, index) in blocks.iter().zip(start.0..) {
            let mut moments = self.moments.borrow_mut();
            if moments.len() < self.most_moments {
                let (disk, safe) = ((*self.disk).clone(), self.safe.borrow().clone());
                moments.push(Moment { disk, index, new: block.contents, safe });
            }
            self.disk.write(std::slice::from_ref(block), BlockIdx(index))?;
        }
        // A card that does not lie has written the blocks of a command when it is no longer busy.
        self.disk.sync()
    }

    fn num_blocks(&self) -> Result<BlockCount, DiskError> {
        self.disk.num_blocks()
    }
}

impl CardSlot for WatchedDisk {
    fn look_again(&self) {}
}

/// A storage, and who gives it records.
pub struct Deck {
    pub disk: Rc<Disk>,
    storage: Storage<'static, WatchedDisk, BareChip>,
    health: &'static Health,
    records: RecordProducer<'static>,
    clock: Clock,
    next_tick: u32,
    sectors_left: u32,
    files: u32,
    safe: Rc<RefCell<Range<u32>>>,
    pub moments: Rc<RefCell<Vec<Moment>>>,
}

fn leak<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

impl Deck {
    /// A body starts on this card; its first epoch has this tick.
    pub fn start(disk: Disk, first_tick: u32, most_moments: usize) -> Self {
        let disk = Rc::new(disk);
        let health: &'static Health = leak(Health::new());
        let (records_in, records) = leak(RecordQueue::new()).split();
        let (_, notices) = leak(heapless::spsc::Queue::<Event, 4>::new()).split();
        let safe = Rc::new(RefCell::new(first_tick..first_tick));
        let moments = Rc::new(RefCell::default());
        let clock = Clock(Rc::new(Cell::new(first_tick)));
        let watched = WatchedDisk {
            disk: disk.clone(),
            safe: safe.clone(),
            moments: Rc::clone(&moments),
            most_moments,
            clock: clock.clone(),
        };
        let input = StorageInput { records: RecordConsumer::new(records), notices };
        let shown = clock.clone();
        let system = BareChip::new(move || shown.0.get(), first_tick);
        let storage = Storage::new(watched, input, &Stored::default(), &FIRMWARE, health, system);
        Self {
            disk,
            storage,
            health,
            records: RecordProducer::new(records_in),
            clock,
            next_tick: first_tick,
            sectors_left: u32::MAX,
            files: 1,
            safe,
            moments,
        }
    }

    /// An epoch, and two steps of the storage.
    pub fn step(&mut self) {
        assert!(self.records.push(&epoch(self.next_tick)), "the queue is full");
        self.next_tick += 1;
        for _ in 0..2 {
            self.clock.pass(50_000);
            self.storage.run();
        }
        let left = self.health.log.sectors_left().unwrap_or(self.sectors_left);
        self.files += u32::from(left > self.sectors_left);
        self.sectors_left = left;
        let records = self.health.counts.get(Count::LogRecordsSafe);
        // A file that failed at once has been begun, too.
        let begun = self.files + self.health.counts.get(Count::LogErrors);
        let mut safe = self.safe.borrow_mut();
        safe.end = safe.end.max(safe.start + records.saturating_sub(RECORDS_OF_BEGINNING * begun));
    }

    /// Files that the session has been in.
    pub fn files(&self) -> u32 {
        self.files
    }

    /// Epochs that are said to be safe.
    pub fn safe(&self) -> Range<u32> {
        self.safe.borrow().clone()
    }
}

/// Time that passes from step to step.
#[derive(Clone)]
struct Clock(Rc<Cell<u32>>);

impl Clock {
    fn pass(&self, us: u32) {
        self.0.set(self.0.get() + us);
    }
}
