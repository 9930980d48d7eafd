//! What went wrong and what ran, in counters that every task can reach without a lock.

use crate::board;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use towmag::link::{Activity, ProgramFaults};

/// Epochs between two frames of figures: every 2 s.
const STATUS_EPOCHS: u32 = 20;

/// Calls of `assemble` without a conversion until the converter counts as silent: 1 s.
const SILENT_CALLS: u32 = 25;

/// Tasks that the watchdog waits for.
#[derive(Clone, Copy)]
pub enum Task {
    Assemble = 1,
    Compensate = 2,
    Storage = 4,
}

const ALL_TASKS: u32 = 7;

/// In place of the room that is left, while no log is open.
const NO_LOG: u32 = u32::MAX;

/// What is counted, in the order of the figures.
#[derive(Clone, Copy)]
pub enum Count {
    ReadingsLost,
    ConversionsLost,
    EpochsLost,
    RecordsLost,
    FramesDropped,
    CableOverruns,
    UartOverruns,
    FluxgateCrcErrors,
    LogErrors,
    LogRecordsSafe,
    ConsoleLinesDropped,
}

/// Number of counters.
pub const COUNTS: usize = 11;

impl Count {
    /// Count one more unless it went well.
    pub fn unless(self, went_well: bool) {
        if !went_well {
            self.add(1);
        }
    }

    /// Count some more.
    pub fn add(self, more: u32) {
        STATUS.counts[self as usize].fetch_add(more, Relaxed);
    }
}

/// All counters.
pub struct Status {
    counts: [AtomicU32; COUNTS],
    epochs: AtomicU32,
    ran: AtomicU32,
    calls_without_conversion: AtomicU32,
    busy_worst: AtomicU32,
    busy_mean: AtomicU32,
    log_is_open: AtomicBool,
    log_fails: AtomicBool,
    log_is_wanted: AtomicBool,
    sectors_left: AtomicU32,
    restart_is_wanted: AtomicBool,
}

/// The one status of the firmware.
pub static STATUS: Status = Status {
    counts: [const { AtomicU32::new(0) }; COUNTS],
    epochs: AtomicU32::new(0),
    ran: AtomicU32::new(0),
    calls_without_conversion: AtomicU32::new(0),
    busy_worst: AtomicU32::new(0),
    busy_mean: AtomicU32::new(0),
    log_is_open: AtomicBool::new(false),
    log_fails: AtomicBool::new(false),
    log_is_wanted: AtomicBool::new(true),
    sectors_left: AtomicU32::new(NO_LOG),
    restart_is_wanted: AtomicBool::new(false),
};

impl Status {
    /// A count that something else keeps.
    pub fn set(&self, count: Count, value: u32) {
        self.counts[count as usize].store(value, Relaxed);
    }

    /// The counters, then the worst and the mean cost of an epoch, the most stack used, bytes, and the ticks that a known
    /// number of instructions takes.
    pub fn values(&self) -> [u32; COUNTS + 4] {
        let mut values = [0; COUNTS + 4];
        for (value, count) in values.iter_mut().zip(&self.counts) {
            *value = count.load(Relaxed);
        }
        values[COUNTS] = self.busy_worst.load(Relaxed);
        values[COUNTS + 1] = self.busy_mean.load(Relaxed);
        values[COUNTS + 2] = board::most_stack_used();
        values[COUNTS + 3] = board::ticks_of_known_loop();
        values
    }

    fn get(&self, count: Count) -> u32 {
        self.counts[count as usize].load(Relaxed)
    }

    /// The counters as the telemetry has them.
    pub fn program_faults(&self) -> ProgramFaults {
        ProgramFaults {
            records_lost: self.get(Count::RecordsLost),
            card_errors: self.get(Count::LogErrors),
            frames_dropped: self.get(Count::FramesDropped),
            console_lines_dropped: self.get(Count::ConsoleLinesDropped),
            console_receive_errors: self.get(Count::CableOverruns),
            epochs_late: self.get(Count::EpochsLost),
            sensor_bytes_lost: self.get(Count::ReadingsLost).saturating_add(self.get(Count::ConversionsLost)),
            restarts_by_fault: board::faults(),
        }
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

    pub fn log_is_wanted(&self) -> bool {
        self.log_is_wanted.load(Relaxed)
    }

    /// Room in the log, sectors.
    pub fn set_sectors_left(&self, sectors: u32) {
        self.sectors_left.store(sectors, Relaxed);
    }

    /// `None` while no log is open.
    pub fn sectors_left(&self) -> Option<u32> {
        Some(self.sectors_left.load(Relaxed)).filter(|&sectors| sectors != NO_LOG)
    }

    /// The log is to be closed, and the chip started anew.
    pub fn ask_for_restart(&self) {
        self.restart_is_wanted.store(true, Relaxed);
    }

    pub fn restart_is_wanted(&self) -> bool {
        self.restart_is_wanted.load(Relaxed)
    }

    /// What the body is doing.
    pub fn activity(&self, calibrating: bool) -> Activity {
        let logging = self.log_is_open.load(Relaxed) && self.log_is_wanted();
        Activity { logging, calibrating, log_failing: self.log_fails.load(Relaxed) }
    }

    pub fn epoch_made(&self) {
        self.epochs.fetch_add(1, Relaxed);
    }

    pub fn epochs(&self) -> u32 {
        self.epochs.load(Relaxed)
    }

    /// What epochs cost so far.
    pub fn set_cost(&self, mean: u32, worst: u32) {
        self.busy_mean.store(mean, Relaxed);
        self.busy_worst.store(worst, Relaxed);
    }

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

    pub fn conversion_came(&self) {
        self.calls_without_conversion.store(0, Relaxed);
    }

    /// True about once a second when no conversion comes.
    pub fn converter_is_silent(&self) -> bool {
        self.calls_without_conversion.fetch_add(1, Relaxed) % SILENT_CALLS == SILENT_CALLS - 1
    }

    pub fn is_due(&self, tick: u32) -> bool {
        tick.is_multiple_of(STATUS_EPOCHS)
    }
}
