//! The processor: Unicorn's Cortex-M4F, with what Unicorn leaves out, the exceptions, around it.

mod engine;
mod exceptions;

use crate::blocks::BRANCH_TO_SELF;
use crate::image::Image;
use crate::machine::{Machine, Stop};
use crate::peripherals::nvic::HARD_FAULT;
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

    /// Change a word of the memory; false where there is none.
    pub(crate) fn set_word(&mut self, address: u32, value: u32) -> bool {
        self.engine.set_word(address, value).is_some()
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

    /// In a loop, with interrupts off.
    pub(crate) fn hang(&mut self) {
        self.engine.set(Register::PRIMASK, 1);
        let place = self.machine().blocks.find(BRANCH_TO_SELF).expect("the image has an endless loop somewhere");
        self.engine.jump(place);
    }

    /// At this address, in what it thinks is a function with these arguments.
    pub(crate) fn stray_to(&mut self, address: u32, arguments: [u32; 3]) {
        for (register, argument) in [Register::R0, Register::R1, Register::R2].into_iter().zip(arguments) {
            self.engine.set(register, argument);
        }
        self.engine.jump(address);
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
            let has_entered = match self.machine_mut().stop.take() {
                Some(Stop::Exception(number)) => self.enter(number),
                Some(Stop::Fault) => !self.machine().bus.core.nvic.is_in_fault() && self.enter(HARD_FAULT),
                Some(Stop::Return) => {
                    self.leave();
                    true
                }
                Some(stop) => return stop,
                None => true,
            };
            if !has_entered {
                return self.lock_up();
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
