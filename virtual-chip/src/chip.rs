//! The chip from power-up to power-down.

use crate::board::Board;
use crate::cpu::Cpu;
use crate::image::Image;
use crate::lines::Lines;
use crate::machine::{Machine, Stop};
use crate::peripherals::bus::Bus;
use crate::peripherals::complaint::Complaint;
use crate::peripherals::flash::Cells;
use crate::peripherals::rcc;
use crate::time::fs;
use crate::wires::serial::Line;

/// A chip that runs.
pub struct Chip<'a> {
    image: &'a Image,
    cpu: Cpu,
    /// Reset flags of each start but the first.
    pub resets: Vec<u32>,
}

/// How a run has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Its time was over.
    Time,
    /// The power went.
    PowerCut,
}

impl<'a> Chip<'a> {
    /// Power comes, with these cells of the flash.
    pub fn power_on(image: &'a Image, board: Board, cells: Cells) -> Self {
        let bus = Bus::new(board, cells, rcc::POWER_ON | rcc::PIN | rcc::BROWN_OUT);
        let mut cpu = Cpu::new(image, Machine::new(bus, &image.flash));
        cpu.forget();
        cpu.reset();
        Self { image, cpu, resets: Vec::new() }
    }

    /// The peripherals, and what is wired to them.
    pub fn bus(&self) -> &Bus {
        &self.cpu.machine().bus
    }

    /// The same, to change it.
    pub fn bus_mut(&mut self) -> &mut Bus {
        &mut self.cpu.machine_mut().bus
    }

    /// The machine.
    pub fn machine(&self) -> &Machine {
        self.cpu.machine()
    }

    /// Put these bytes into the memory.
    ///
    /// # Panics
    ///
    /// When there is none.
    pub fn set_memory(&mut self, address: u32, bytes: &[u8]) {
        for (at, word) in (address..).step_by(4).zip(bytes.chunks(4)) {
            let mut padded = [0; 4];
            padded[..word.len()].copy_from_slice(word);
            assert!(self.cpu.set_word(at, u32::from_le_bytes(padded)), "there is no memory at {at:#010x}");
        }
    }

    /// After something was put onto its wires.
    pub fn replan(&mut self) {
        self.cpu.machine_mut().plan();
    }

    /// The power goes: what is left of the board, and of the cells. The chip that stays behind has nothing on its wires.
    pub fn power_off(&mut self) -> (Board, Cells) {
        let nothing = Bus::new(Board::default(), Cells::default(), 0);
        let (mut board, cells) = std::mem::replace(&mut self.cpu.machine_mut().bus, nothing).into_parts();
        board.lines.iter_mut().for_each(Line::restart_clock);
        (board, cells)
    }

    /// The program hangs, with interrupts off.
    pub fn hang(&mut self) {
        self.cpu.hang();
    }

    /// The program goes on at this address, in what it thinks is a function with these arguments.
    pub fn stray_to(&mut self, address: u32, arguments: [u32; 3]) {
        self.cpu.stray_to(address, arguments);
    }

    /// Run for so many seconds.
    ///
    /// # Panics
    ///
    /// When the program does what the chip does not bear, or what is not modelled.
    pub fn run(&mut self, seconds: f64) -> End {
        let machine = self.cpu.machine_mut();
        machine.end_fs = machine.now_fs + fs(seconds);
        machine.plan();
        loop {
            match self.cpu.run() {
                Stop::Time => return End::Time,
                Stop::PowerCut => return End::PowerCut,
                Stop::Reset(flags) => self.reset(flags),
                Stop::Complaint(Complaint(text)) => panic!("{}: the program {text}", self.place()),
                Stop::Exception(_) | Stop::Return | Stop::Fault => unreachable!("the processor's own"),
            }
        }
    }

    /// The line of the source that runs.
    fn place(&self) -> String {
        Lines::read(self.image).place(self.cpu.machine().last_block)
    }

    fn reset(&mut self, flags: u32) {
        self.resets.push(flags);
        let machine = self.cpu.machine_mut();
        machine.bus.reset(flags | rcc::PIN, machine.now_fs);
        machine.plan();
        self.cpu.reset();
    }
}
