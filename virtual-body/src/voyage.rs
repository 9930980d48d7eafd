//! The task of the storage as it is on the board, on a card on its bus, through hours of virtual time.

use crate::bare_chip::BareChip;
use crate::log::epoch;
use crate::sd::{SdCard, VirtualBus, VirtualDelay, VirtualSelect, World};
use std::cell::Cell;
use std::rc::Rc;
use towmag::body::Firmware;
use towmag::health::{Count, Health, Task};
use towmag::log::{Event, RecordConsumer, RecordProducer, RecordQueue};
use towmag::sd_card::SpiCard;
use towmag::storage::{Storage, StorageInput};
use towmag::store::{BodySettings, Stored};

const FIRMWARE: Firmware = Firmware { version: "0.1.0-test", commit: "5a5a" };

/// Shorter than the body's watchdog ever waits, 6 s.
const WATCHDOG_NS: u64 = 5_400_000_000;

/// The rate of the epochs.
const EPOCH_NS: u64 = 100_000_000;

type VirtualCard = SpiCard<VirtualBus, VirtualSelect, VirtualDelay, BareChip>;

/// What the higher priorities have seen.
#[derive(Default)]
pub struct Seen {
    /// Epochs made, the next one's tick.
    pub epochs: Cell<u32>,
    /// The longest time without a sign of life of every task, ns.
    pub longest_silence_ns: Cell<u64>,
    /// Watchdog resets that there would have been.
    pub resets: Cell<u32>,
}

/// A body at sea: its storage, and what goes on around it.
pub struct Voyage {
    pub world: Rc<World>,
    pub health: &'static Health,
    pub seen: Rc<Seen>,
    storage: Storage<'static, VirtualCard, BareChip>,
    /// The longest step of the storage, ns.
    pub longest_step_ns: u64,
    last_step_ns: u64,
}

fn leak<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

/// What `assemble` and `compensate` do, as far as it concerns the storage.
fn watch(health: &'static Health, seen: Rc<Seen>, mut records: RecordProducer<'static>) -> impl FnMut(u64) {
    let (mut fed_ns, mut next_epoch_ns) = (None, None);
    move |now_ns| {
        while *next_epoch_ns.get_or_insert(now_ns) <= now_ns {
            let tick = seen.epochs.get();
            if !records.push(&epoch(tick)) {
                health.counts.add(Count::RecordsLost, 1);
            }
            seen.epochs.set(tick + 1);
            next_epoch_ns = next_epoch_ns.map(|next| next + EPOCH_NS);
        }
        health.tasks.ran(Task::Assemble);
        health.tasks.ran(Task::Compensate);
        let silence_ns = now_ns - *fed_ns.get_or_insert(now_ns);
        seen.longest_silence_ns.set(seen.longest_silence_ns.get().max(silence_ns));
        if health.tasks.all_ran() {
            fed_ns = Some(now_ns);
        } else if silence_ns > WATCHDOG_NS {
            seen.resets.set(seen.resets.get() + 1);
            fed_ns = Some(now_ns);
        }
    }
}

impl Voyage {
    /// A body starts, with this card or with none, and with files of so many hours.
    pub fn start(card: Option<SdCard>, log_file_h: u32) -> Self {
        let world = World::new(card);
        let health: &'static Health = leak(Health::new());
        let (records_in, records) = leak(RecordQueue::new()).split();
        let (_, notices) = leak(heapless::spsc::Queue::<Event, 4>::new()).split();
        let seen = Rc::new(Seen::default());
        world.set_work(watch(health, seen.clone(), RecordProducer::new(records_in)));
        let settings = BodySettings { log_file_h, ..BodySettings::default() };
        let stored = Stored { settings, ..Stored::default() };
        let clock = world.clone();
        let system = BareChip::new(move || (clock.now_ns() / 1_000) as u32, 1);
        let (bus, select) = (VirtualBus(world.clone()), VirtualSelect(world.clone()));
        let card = SpiCard::new(bus, select, VirtualDelay(world.clone()), system.clone());
        let input = StorageInput { records: RecordConsumer::new(records), notices };
        let storage = Storage::new(card, input, &stored, &FIRMWARE, health, system);
        Self { world, health, seen, storage, longest_step_ns: 0, last_step_ns: 0 }
    }

    /// One step of the storage, and to the next tick. Returns how long the step took, s.
    pub fn step(&mut self) -> f64 {
        let begin_ns = self.world.now_ns();
        self.storage.run();
        self.last_step_ns = self.world.now_ns() - begin_ns;
        self.longest_step_ns = self.longest_step_ns.max(self.last_step_ns);
        self.world.sleep();
        self.last_step_ns as f64 * 1e-9
    }

    /// Whether something is safe, and the storage had nothing to do at its last step.
    pub fn is_idle(&self) -> bool {
        self.safe() > 0 && self.last_step_ns == 0
    }

    /// So many seconds.
    pub fn sail(&mut self, seconds: f64) {
        let end_s = self.world.now_s() + seconds;
        while self.world.now_s() < end_s {
            self.step();
        }
    }

    /// Write out all that there is.
    pub fn close(&mut self) {
        self.health.ask_for_restart();
        self.storage.run();
    }

    /// Records that are said to be safe.
    pub fn safe(&self) -> u32 {
        self.health.counts.get(Count::LogRecordsSafe)
    }

    /// Records that found no room.
    pub fn lost(&self) -> u32 {
        self.health.counts.get(Count::RecordsLost)
    }
}
