//! What the processor meets while it runs: time, registers, and reasons to stop.

use crate::blocks::Blocks;
use crate::clocks::Moment;
use crate::peripherals::bus::Bus;
use crate::peripherals::complaint::Complaint;
use crate::peripherals::nvic::Masks;
use crate::time::{NEVER_FS, period_fs};

/// Why the processor has stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The time of the run is over.
    Time,
    /// This exception goes first.
    Exception(u32),
    /// A handler returns.
    Return,
    /// By software, the watchdog, or because the core has lost its clock: see `flags` of the reset.
    Reset(u32),
    /// The power goes.
    PowerCut,
    /// The processor reads or writes where there is nothing.
    Fault,
    /// It makes no sense to go on.
    Complaint(Complaint),
}

/// The peripherals and the time.
pub struct Machine {
    /// The peripherals.
    pub bus: Bus,
    /// Since power came, femtoseconds.
    pub now_fs: u64,
    /// End of the run, femtoseconds.
    pub end_fs: u64,
    /// The processor is to stop, for this reason.
    pub stop: Option<Stop>,
    /// Code that has run.
    pub blocks: Blocks,
    /// Where the latest block began.
    pub last_block: u32,
    cycle_fs: u64,
    due_fs: u64,
}

impl Machine {
    /// With these peripherals, and this content of the flash.
    pub fn new(bus: Bus, flash: &[u8]) -> Self {
        let mut machine = Self {
            bus,
            now_fs: 0,
            end_fs: 0,
            stop: None,
            blocks: Blocks::new(flash),
            last_block: 0,
            cycle_fs: 1,
            due_fs: 0,
        };
        machine.plan();
        machine
    }

    /// Now, with the clocks. Without a clock nothing asks.
    fn moment(&self) -> Option<Moment> {
        Some(Moment { fs: self.now_fs, clocks: self.bus.clocks? })
    }

    /// After something has changed: when the next thing happens, and how long a cycle is.
    pub fn plan(&mut self) {
        self.due_fs = self.bus.due_fs().min(self.end_fs);
        self.cycle_fs = self.bus.clocks.map_or(NEVER_FS, |clocks| period_fs(clocks.core_hz));
    }

    /// Before a block of code. Returns whether an exception waits.
    pub fn look(&mut self) -> bool {
        if self.stop.is_some() {
            return false;
        }
        self.now_fs = self.now_fs.max(self.bus.flash.busy_until_fs());
        self.settle();
        self.stop.is_none() && self.bus.core.nvic.has_candidate()
    }

    /// Stop for the exception that waits, if it goes first.
    pub fn preempt(&mut self, masks: Masks) {
        self.stop = self.bus.core.nvic.next(masks).map(Stop::Exception);
    }

    /// A block of code runs, unless the processor is to stop.
    pub fn run_block(&mut self, address: u32, size: u32) -> bool {
        if self.stop.is_some() {
            return false;
        }
        if self.last_block == address && self.blocks.is_endless(address) {
            self.skip();
        }
        self.last_block = address;
        let instructions = self.blocks.run(address, size);
        self.pass(instructions.into());
        true
    }

    /// So many cycles.
    pub fn pass(&mut self, cycles: u64) {
        self.now_fs += cycles * self.cycle_fs;
    }

    /// The processor sleeps until something wakes it.
    pub fn sleep(&mut self, masks: Masks) {
        // Masked interrupts wake it as well.
        let masks = Masks { primask: false, ..masks };
        while self.stop.is_none() && self.bus.core.nvic.next(masks).is_none() {
            self.skip();
        }
    }

    /// To the next thing that happens.
    pub fn skip(&mut self) {
        self.now_fs = self.now_fs.max(self.due_fs);
        self.settle();
    }

    /// What has happened by now.
    fn settle(&mut self) {
        if self.now_fs < self.due_fs {
            return;
        }
        if self.now_fs >= self.bus.watchdog.due_fs() {
            self.stop = Some(Stop::Reset(crate::peripherals::rcc::WATCHDOG));
        } else if self.now_fs >= self.end_fs {
            self.stop = Some(Stop::Time);
        }
        self.bus.elapse(self.now_fs);
        self.plan();
    }

    /// The processor reads a register.
    pub fn read(&mut self, address: u32, size: usize) -> u32 {
        self.settle();
        if self.bus.is_polled(address) {
            self.skip();
        }
        let Some(moment) = self.moment() else { return 0 };
        let word = address & !3;
        match self.bus.read(word, moment) {
            Ok(value) => value >> (8 * (address - word)) & mask(size),
            Err(complaint) => {
                self.complain(complaint);
                0
            }
        }
    }

    /// The processor writes a register.
    pub fn write(&mut self, address: u32, value: u32, size: usize) {
        self.settle();
        let Some(moment) = self.moment() else { return };
        if let Err(complaint) = self.bus.write(address, value, size, moment) {
            self.complain(complaint);
        }
        if self.bus.core.wants_reset {
            self.stop.get_or_insert(Stop::Reset(crate::peripherals::rcc::SOFTWARE));
        }
        if self.bus.flash.is_cut {
            self.stop = Some(Stop::PowerCut);
        }
        self.plan();
    }

    /// The processor programs the flash; `at` counts from the first byte of the settings.
    pub fn program(&mut self, at: usize, value: u32, size: usize) {
        self.bus.flash.program(at, value, size, self.now_fs);
        if self.bus.flash.is_cut {
            self.stop = Some(Stop::PowerCut);
        }
    }

    fn complain(&mut self, complaint: Complaint) {
        self.stop.get_or_insert(Stop::Complaint(complaint));
    }
}

fn mask(size: usize) -> u32 {
    if size >= 4 { u32::MAX } else { (1 << (8 * size)) - 1 }
}
