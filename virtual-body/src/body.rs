//! The firmware on the board in memory: the tasks of `src/main.rs`, called in turn instead of by interrupts.

use std::mem::MaybeUninit;
use std::rc::Rc;

use towmag::body::{Firmware, build_pipeline};
use towmag::connect::{Connected, connect};
use towmag::console::receive;
use towmag::hardware::{Board, LightOutput, Meter};
use towmag::health::{Health, Task};
use towmag::link::{FrameKind, FrameReader, HousekeepingMessage, NavigationMessage, Telemetry};
use towmag::log::{Event, Record, Recovered};
use towmag::queues::Queues;
use towmag::store::{BodySettings, SettingsStore, Stored};

use super::board::{Bench, BenchBoard, OnBench, SECTORS};
use super::log::recover_file;

const FIRMWARE: Firmware = Firmware { version: "0.1.0-test", commit: "5a5a" };

/// Five to a reading of the scalar sensor, two to a call of `assemble`.
const STEPS_PER_S: u32 = 50;

/// A body from its start on.
pub struct Body {
    pub bench: Rc<Bench>,
    pub health: &'static Health,
    /// What each task works on.
    pub tasks: Connected<BenchBoard>,
    /// The card takes its time: the task of the storage does not come back.
    pub storage_waits: bool,
    /// The task of the console does not get its turn.
    pub console_waits: bool,
    fluxgate_wakes: u32,
    /// What the scalar sensor sends ten times a second.
    pub scalar_sentence: &'static str,
}

/// What has come up the cable.
#[derive(Default)]
pub struct Received {
    pub telemetry: Vec<Telemetry>,
    pub navigation: Vec<NavigationMessage>,
    pub housekeeping: Vec<HousekeepingMessage>,
    pub figures: Vec<Vec<u32>>,
    pub texts: Vec<String>,
    pub bad: u32,
}

impl Received {
    /// What these bytes hold.
    pub fn of(bytes: impl IntoIterator<Item = u8>) -> Self {
        let mut received = Self::default();
        let mut frames = FrameReader::default();
        for byte in bytes {
            let Some(frame) = frames.push(byte) else { continue };
            match frame.kind {
                FrameKind::Telemetry => received.telemetry.extend(Telemetry::decode(frame.body)),
                FrameKind::Navigation => received.navigation.extend(NavigationMessage::decode(frame.body)),
                FrameKind::Housekeeping => received.housekeeping.extend(HousekeepingMessage::decode(frame.body)),
                FrameKind::Text => received.texts.push(String::from_utf8(frame.body.to_vec()).unwrap()),
                FrameKind::Figures => received
                    .figures
                    .push(frame.body.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()),
            }
        }
        received.bad = frames.counters().bad;
        received
    }
}

/// Put settings into the flash: a log of an hour, as a small card has room for.
pub fn store(bench: &Rc<Bench>, change: impl FnOnce(&mut Stored)) {
    let settings = BodySettings { log_file_h: 1, ..BodySettings::default() };
    let mut stored = Stored { settings, ..Stored::default() };
    change(&mut stored);
    let mut flash = OnBench(bench.clone());
    let (mut store, _) = SettingsStore::open(&mut flash, SECTORS).unwrap();
    store.save(&mut flash, &stored).unwrap();
}

/// A queue that lives as long as the tasks: the tests start few bodies.
fn leak<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

impl Body {
    /// Start it, as `init` does.
    pub fn start(bench: &Rc<Bench>) -> Self {
        let parts = BenchBoard::start(bench.clone());
        let stored = parts.settings.stored;
        let health: &'static Health = leak(Health::new());
        health.begin(&parts.system, &stored.settings);
        let pipeline = build_pipeline(leak(MaybeUninit::uninit()), &stored);
        let mut tasks = connect(parts, pipeline, leak(Queues::new()), &FIRMWARE, health);
        tasks.meter.sleep(0, |cost| health.set_cost(cost));
        Self {
            bench: bench.clone(),
            health,
            tasks,
            storage_waits: false,
            console_waits: false,
            fluxgate_wakes: 0,
            scalar_sentence: "$ 49800.131,1249\r\n",
        }
    }

    /// Let it live for so many seconds, with ten readings of the scalar sensor in each.
    pub fn live(&mut self, seconds: u32) {
        for step in 0..seconds * STEPS_PER_S {
            self.bench.now_us.set(self.bench.now_us.get().wrapping_add(1_000_000 / STEPS_PER_S));
            if step % 5 == 0 {
                self.bench.scalar_bytes.borrow_mut().extend(self.scalar_sentence.bytes());
                self.tasks.scalar_input.run();
            }
            while !self.bench.nmea_bytes.borrow().is_empty() {
                self.tasks.nmea_input.run();
            }
            if step % 2 == 0 {
                self.tick();
            }
        }
    }

    /// One call of `assemble`, and what it spawns.
    pub fn tick(&mut self) {
        self.tasks.assembler.run();
        if self.bench.fluxgate_wakes.get() > self.fluxgate_wakes {
            self.fluxgate_wakes = self.bench.fluxgate_wakes.get();
            self.tasks.fluxgate_input.run();
        }
        if let Some(stamp_us) = self.bench.second_pulse.take() {
            self.tasks.context.pulse(stamp_us);
        }
        while let Some(epoch) = self.tasks.compensator.step() {
            let Connected { compensator, context, housekeeping, .. } = &mut self.tasks;
            let lights = compensator.publish(context, &epoch, housekeeping);
            OnBench(self.bench.clone()).show(lights);
            self.tasks.sender.wake();
        }
        self.health.tasks.ran(Task::Compensate);
        self.cable();
        if !self.console_waits {
            self.tasks.console.run(&mut self.tasks.context);
            self.tasks.sender.wake();
        }
        self.cable();
        if !self.storage_waits {
            self.tasks.storage.run();
        }
    }

    /// The task of the cable, as long as its interrupt comes.
    pub fn cable(&mut self) {
        loop {
            let bench = OnBench(self.bench.clone());
            receive(&mut bench.clone(), &mut self.tasks.from_ship, self.health, &bench);
            self.tasks.sender.send(|| self.tasks.to_ship.dequeue());
            let has_more = !self.bench.from_ship.borrow().is_empty();
            if !has_more {
                return;
            }
        }
    }

    /// Something comes on the third UART.
    pub fn hear(&self, bytes: &[u8]) {
        self.bench.nmea_bytes.borrow_mut().extend(bytes.iter().copied().map(Some));
    }

    /// The ship sends something.
    pub fn send(&self, text: &str) {
        self.bench.from_ship.borrow_mut().extend(text.bytes().map(Some));
    }

    /// What has come up since the last call.
    pub fn received(&self) -> Received {
        Received::of(self.bench.to_ship.take())
    }

    /// What is in the log, after its last sector has been written.
    pub fn logged(&mut self) -> Vec<Record> {
        self.health.ask_for_restart();
        self.live(1);
        let log = recover_file(self.bench.card.borrow().as_ref().unwrap(), "TOWMAG01.BIN").unwrap();
        let record = |item| if let Recovered::Record(record) = item { Some(record) } else { None };
        log.items.into_iter().filter_map(record).collect()
    }

    /// The events among it.
    pub fn events(&mut self) -> Vec<Event> {
        let event = |record| if let Record::Event(event) = record { Some(event) } else { None };
        self.logged().into_iter().filter_map(event).collect()
    }

    /// A line to the console, and what it answers within two seconds.
    pub fn answer(&mut self, line: &str) -> Vec<String> {
        self.received();
        self.send(&format!("{line}\r"));
        self.live(2);
        self.received().texts
    }
}
