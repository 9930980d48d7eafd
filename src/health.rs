//! What went wrong and what ran, in counters that every task can reach without a lock.

use crate::hardware::{EpochCost, System};
use crate::link::{Activity, FaultCounters, ProgramFaults, converter_counts, grid_counts, scalar_counts};
use crate::sensors::ads131m04::AdcFaults;
use crate::sensors::grid::GridCounters;
use crate::sensors::scalar::ScalarFaults;
use crate::store::BodySettings;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

/// Epochs between two frames of figures: every 2 s.
const FIGURES_EPOCHS: u32 = 20;

/// Calls of `assemble` without a conversion until the converter counts as silent: 1 s.
const SILENT_CALLS: u32 = 25;

/// Tasks that the watchdog waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Readings and conversions to epochs.
    Assemble = 1,
    /// Epochs to outputs.
    Compensate = 2,
    /// The log to the card.
    Storage = 4,
}

const ALL_TASKS: u32 = 7;

/// In place of the room that is left, while no log is open.
const NO_LOG: u32 = u32::MAX;

/// What the program counts. What a driver counts itself, it hands over as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// Scalar readings that found no room in their queue.
    ReadingsLost,
    /// Conversions that found no room in their queue.
    ConversionsLost,
    /// Epochs that found no room in their queue.
    EpochsLost,
    /// Log records that found no room in their queue.
    RecordsLost,
    /// Telemetry frames that found no room in the transmitter's queue.
    FramesDropped,
    /// Bytes of the console that found no room in their queue, and errors of its receiver.
    CableOverruns,
    /// Attempts to write the log, or to find a card, that failed.
    LogErrors,
    /// Log records that would survive a power cut.
    LogRecordsSafe,
    /// Console lines dropped because they were overlong or damaged.
    ConsoleLinesDropped,
    /// Panics, hard faults and resets by the watchdog since power came.
    RestartsByFault,
}

const COUNTS: usize = 10;

/// Number of values in the frame of figures.
pub const FIGURES: usize = 15;

/// What the figures tell besides what this counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChipFigures {
    /// The most stack that was ever in use, bytes.
    pub stack_bytes: u32,
    /// Ticks of the cost's meter that 100,000 instructions take; 0 where they are clock cycles.
    pub ticks_of_known_loop: u32,
}

/// Counters of one kind, each of which is written by one task alone.
#[derive(Debug)]
struct Counters<const N: usize>([AtomicU32; N]);

impl<const N: usize> Counters<N> {
    const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; N])
    }

    fn set(&self, values: [u32; N]) {
        self.0.iter().zip(values).for_each(|(counter, value)| counter.store(value, Relaxed));
    }

    fn get(&self) -> [u32; N] {
        self.0.each_ref().map(|counter| counter.load(Relaxed))
    }
}

/// All counters, and what one task tells another in passing.
#[derive(Debug)]
pub struct Health {
    counts: Counters<COUNTS>,
    scalar: Counters<11>,
    converter: Counters<8>,
    grid: Counters<9>,
    epochs: AtomicU32,
    ran: AtomicU32,
    calls_without_conversion: AtomicU32,
    cost_worst: AtomicU32,
    cost_mean: AtomicU32,
    log_is_open: AtomicBool,
    log_fails: AtomicBool,
    log_is_wanted: AtomicBool,
    sectors_left: AtomicU32,
    restart_is_wanted: AtomicBool,
}

impl Default for Health {
    fn default() -> Self {
        Self::new()
    }
}

impl Health {
    /// Nothing has happened yet.
    pub const fn new() -> Self {
        Self {
            counts: Counters::new(),
            scalar: Counters::new(),
            converter: Counters::new(),
            grid: Counters::new(),
            epochs: AtomicU32::new(0),
            ran: AtomicU32::new(0),
            calls_without_conversion: AtomicU32::new(0),
            cost_worst: AtomicU32::new(0),
            cost_mean: AtomicU32::new(0),
            log_is_open: AtomicBool::new(false),
            log_fails: AtomicBool::new(false),
            log_is_wanted: AtomicBool::new(true),
            sectors_left: AtomicU32::new(NO_LOG),
            restart_is_wanted: AtomicBool::new(false),
        }
    }

    /// First of all after a start: how often faults ended one before, and whether the settings want a log.
    pub fn begin(&self, system: &impl System, settings: &BodySettings) {
        self.set(Count::RestartsByFault, system.restarts_by_fault());
        self.want_log(settings.log);
    }

    /// Count some more.
    pub fn add(&self, count: Count, more: u32) {
        self.counter(count).fetch_add(more, Relaxed);
    }

    /// Count one more if it is so.
    pub fn count_if(&self, is_so: bool, count: Count) {
        if is_so {
            self.add(count, 1);
        }
    }

    /// A count that something else keeps.
    pub fn set(&self, count: Count, value: u32) {
        self.counter(count).store(value, Relaxed);
    }

    /// A count as it is.
    pub fn get(&self, count: Count) -> u32 {
        self.counter(count).load(Relaxed)
    }

    fn counter(&self, count: Count) -> &AtomicU32 {
        &self.counts.0[count as usize]
    }

    /// What the scalar sensor's parser has counted.
    pub fn set_scalar(&self, faults: &ScalarFaults) {
        self.scalar.set(scalar_counts(faults));
    }

    /// What the converter's driver has counted.
    pub fn set_converter(&self, faults: &AdcFaults) {
        self.converter.set(converter_counts(faults));
    }

    /// What the grid has counted.
    pub fn set_grid(&self, counters: &GridCounters) {
        self.grid.set(grid_counts(counters));
    }

    /// Every fault counter of the body, as the cable has them.
    pub fn faults(&self) -> FaultCounters {
        let program = ProgramFaults {
            records_lost: self.get(Count::RecordsLost),
            card_errors: self.get(Count::LogErrors),
            frames_dropped: self.get(Count::FramesDropped),
            console_lines_dropped: self.get(Count::ConsoleLinesDropped),
            console_receive_errors: self.get(Count::CableOverruns),
            epochs_late: self.get(Count::EpochsLost),
            sensor_bytes_lost: self.get(Count::ReadingsLost).saturating_add(self.get(Count::ConversionsLost)),
            restarts_by_fault: self.get(Count::RestartsByFault),
        };
        FaultCounters::new(self.scalar.get(), self.converter.get(), self.grid.get(), &program)
    }

    /// The values of the frame of figures, in its order: see `host-sim/src/emulator/telemetry.rs`.
    pub fn figures(&self, chip: ChipFigures) -> [u32; FIGURES] {
        let faults = self.faults();
        [
            self.get(Count::ReadingsLost),
            self.get(Count::ConversionsLost),
            self.get(Count::EpochsLost),
            self.get(Count::RecordsLost),
            self.get(Count::FramesDropped),
            self.get(Count::CableOverruns),
            faults.scalar_overruns(),
            faults.converter_crc(),
            self.get(Count::LogErrors),
            self.get(Count::LogRecordsSafe),
            self.get(Count::ConsoleLinesDropped),
            self.cost_worst.load(Relaxed),
            self.cost_mean.load(Relaxed),
            chip.stack_bytes,
            chip.ticks_of_known_loop,
        ]
    }

    /// Whether the frame of figures goes out with this epoch.
    pub fn figures_are_due(&self, tick: u32) -> bool {
        tick.is_multiple_of(FIGURES_EPOCHS)
    }

    /// How the log is: open on a card, and whether that failed the last time.
    pub fn set_log(&self, is_open: bool, fails: bool) {
        self.log_is_open.store(is_open, Relaxed);
        self.log_fails.store(fails, Relaxed);
    }

    /// Whether the operator wants epochs on the card.
    pub fn want_log(&self, is_wanted: bool) {
        self.log_is_wanted.store(is_wanted, Relaxed);
    }

    /// See [`want_log`](Self::want_log).
    pub fn log_is_wanted(&self) -> bool {
        self.log_is_wanted.load(Relaxed)
    }

    /// Room in the log, sectors.
    pub fn set_sectors_left(&self, sectors: u32) {
        self.sectors_left.store(sectors, Relaxed);
    }

    /// Room in the log, sectors; `None` while none is open.
    pub fn sectors_left(&self) -> Option<u32> {
        Some(self.sectors_left.load(Relaxed)).filter(|&sectors| sectors != NO_LOG)
    }

    /// The log is to be closed, and the chip started anew.
    pub fn ask_for_restart(&self) {
        self.restart_is_wanted.store(true, Relaxed);
    }

    /// See [`ask_for_restart`](Self::ask_for_restart).
    pub fn restart_is_wanted(&self) -> bool {
        self.restart_is_wanted.load(Relaxed)
    }

    /// What the body is doing.
    pub fn activity(&self, calibrating: bool) -> Activity {
        let logging = self.log_is_open.load(Relaxed) && self.log_is_wanted();
        Activity { logging, calibrating, log_failing: self.log_fails.load(Relaxed) }
    }

    /// Another epoch.
    pub fn epoch_made(&self) {
        self.epochs.fetch_add(1, Relaxed);
    }

    /// Epochs made so far.
    pub fn epochs(&self) -> u32 {
        self.epochs.load(Relaxed)
    }

    /// What epochs cost so far.
    pub fn set_cost(&self, cost: EpochCost) {
        self.cost_mean.store(cost.mean, Relaxed);
        self.cost_worst.store(cost.worst, Relaxed);
    }

    /// A task is alive.
    pub fn ran(&self, task: Task) {
        self.ran.fetch_or(task as u32, Relaxed);
    }

    /// Whether every task has run since this was last true.
    pub fn all_ran(&self) -> bool {
        let all = self.ran.load(Relaxed) == ALL_TASKS;
        if all {
            self.ran.store(0, Relaxed);
        }
        all
    }

    /// The converter is not silent.
    pub fn conversion_came(&self) {
        self.calls_without_conversion.store(0, Relaxed);
    }

    /// True about once a second when no conversion comes.
    pub fn converter_is_silent(&self) -> bool {
        self.calls_without_conversion.fetch_add(1, Relaxed) % SILENT_CALLS == SILENT_CALLS - 1
    }
}
