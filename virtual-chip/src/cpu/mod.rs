//! The processor: Unicorn's Cortex-M4F, with what Unicorn leaves out, the exceptions, around it.

mod engine;
mod exceptions;

use crate::image::Image;
use crate::machine::{Machine, Stop};
use crate::peripherals::bus::Complaint;
use engine::Engine;
use unicorn_engine::RegisterARM as Register;

/// Where the reset vector is among the vectors; before it is the first address of the stack.
const VECTOR_RESET: u32 = 4;

/// The processor with its memories.
pub(crate) struct Cpu {
    engine: Engine,
}

impl Cpu {
    /// Without power; what is in the memories nobody knows.
    pub(crate) fn new(image: &Image, machine: Machine) -> Self {
        Self { engine: Engine::new(image, machine) }
    }

    /// What it meets.
    pub(crate) fn machine(&self) -> &Machine {
        self.engine.machine()
    }

    /// What it meets, to change it.
    pub(crate) fn machine_mut(&mut self) -> &mut Machine {
        self.engine.machine_mut()
    }

    /// The word at an address of the memory; `None` where there is none.
    pub(crate) fn word(&self, address: u32) -> Option<u32> {
        self.engine.word(address)
    }

    /// Power comes: the memories hold anything.
    pub(crate) fn forget(&mut self) {
        self.engine.forget();
    }

    /// From the reset vector on.
    pub(crate) fn reset(&mut self) {
        self.engine.reset_registers();
        let base = self.vectors();
        let (stack, entry) = (self.engine.word(base), self.engine.word(base + VECTOR_RESET));
        self.engine.set(Register::SP, stack.unwrap_or(0));
        self.engine.jump(entry.unwrap_or(0));
    }

    /// Until there is a reason to stop that is none of the processor's own.
    pub(crate) fn run(&mut self) -> Stop {
        loop {
            if self.machine().bus.clocks.is_none() {
                // Nothing but the watchdog goes on.
                while self.machine().stop.is_none() {
                    self.machine_mut().skip();
                }
            }
            if self.machine().stop.is_none() {
                self.engine.run();
            }
            match self.machine_mut().stop.take() {
                Some(Stop::Exception(number)) => {
                    if !self.enter(number) {
                        return self.lock_up();
                    }
                }
                Some(Stop::Return) => self.leave(),
                Some(Stop::Fault) => {
                    if self.machine().bus.core.nvic.is_in_fault() || !self.enter(crate::peripherals::nvic::HARD_FAULT) {
                        return self.lock_up();
                    }
                }
                Some(Stop::Complaint(Complaint(text))) => {
                    let place = self.machine().last_block;
                    return Stop::Complaint(Complaint(format!("at {place:#010x}: the program {text}")));
                }
                Some(stop) => return stop,
                None => {}
            }
        }
    }

    /// A fault while a fault is being handled: only a reset ends that.
    fn lock_up(&mut self) -> Stop {
        loop {
            self.machine_mut().skip();
            match self.machine_mut().stop.take() {
                Some(Stop::Exception(_)) | None => {}
                Some(stop) => return stop,
            }
        }
    }

    fn vectors(&self) -> u32 {
        match self.machine().bus.core.vectors {
            0 => crate::image::FLASH_BASE,
            base => base,
        }
    }
}
