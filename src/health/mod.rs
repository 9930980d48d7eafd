//! How the body is: what went wrong and what ran, in counters that every task can reach without a lock.

mod checks;
mod counts;
mod log_state;
mod tasks;

pub use checks::{CardCheck, Checks, ConverterCheck};
pub use counts::{Count, Counts};
pub use log_state::LogState;
pub use tasks::{Task, Tasks};

use crate::hardware::{EpochCost, System};
use crate::lights::Trouble;
use crate::link::Activity;
use crate::store::BodySettings;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

/// Epochs between two frames of figures: every 2 s.
const FIGURES_EPOCHS: u32 = 20;

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

/// All counters, and what one task tells another in passing.
#[derive(Debug)]
pub struct Health {
    /// What went wrong.
    pub counts: Counts,
    /// What ran.
    pub tasks: Tasks,
    /// How the log is.
    pub log: LogState,
    /// What the parts have found out about themselves.
    pub checks: Checks,
    cost_worst: AtomicU32,
    cost_mean: AtomicU32,
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
            counts: Counts::new(),
            tasks: Tasks::new(),
            log: LogState::new(),
            checks: Checks::new(),
            cost_worst: AtomicU32::new(0),
            cost_mean: AtomicU32::new(0),
            restart_is_wanted: AtomicBool::new(false),
        }
    }

    /// First of all after a start: how often faults ended one before, and whether the settings want a log.
    pub fn begin(&self, system: &impl System, settings: &BodySettings) {
        self.counts.set(Count::RestartsByFault, system.restarts_by_fault());
        self.log.want(settings.log);
    }

    /// What the red light tells besides the sensors.
    pub fn trouble(&self) -> Trouble {
        if self.counts.get(Count::CrystalFailed) > 0 {
            Trouble::CrystalFailed
        } else if self.counts.get(Count::RestartsByFault) > 0 {
            Trouble::Restarted
        } else {
            Trouble::None
        }
    }

    /// What the body is doing.
    pub fn activity(&self, calibrating: bool) -> Activity {
        Activity { logging: self.log.is_logging(), calibrating, log_failing: self.log.is_failing() }
    }

    /// The log is to be closed, and the chip started anew.
    pub fn ask_for_restart(&self) {
        self.restart_is_wanted.store(true, Relaxed);
    }

    /// See [`ask_for_restart`](Self::ask_for_restart).
    pub fn restart_is_wanted(&self) -> bool {
        self.restart_is_wanted.load(Relaxed)
    }

    /// What epochs cost so far.
    pub fn set_cost(&self, cost: EpochCost) {
        self.cost_mean.store(cost.mean, Relaxed);
        self.cost_worst.store(cost.worst, Relaxed);
    }

    /// The values of the frame of figures, in its order: see `host-sim/src/emulator/telemetry.rs`.
    pub fn figures(&self, chip: ChipFigures) -> [u32; FIGURES] {
        let faults = self.counts.faults();
        [
            self.counts.get(Count::ReadingsLost),
            self.counts.get(Count::ConversionsLost),
            self.counts.get(Count::EpochsLost),
            self.counts.get(Count::RecordsLost),
            self.counts.get(Count::FramesDropped),
            self.counts.get(Count::CableOverruns),
            faults.scalar_overruns(),
            faults.converter_crc(),
            self.counts.get(Count::LogErrors),
            self.counts.get(Count::LogRecordsSafe),
            self.counts.get(Count::ConsoleLinesDropped),
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
}
