//! The ADS131M04 at the other end of SPI1: frames of six 24-bit words, registers, CRCs and data-ready (data sheet, 8.5).

use crate::time::fs;
use crc::{CRC_16_IBM_3740, Crc};

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

const FRAME_BYTES: usize = 18;

/// Its clock input, Hz; the modulator runs at half of it.
const CLOCK_HZ: f64 = 8_192_000.0;

/// Registers by address.
const STATUS: usize = 1;
const MODE: usize = 2;
const CLOCK: usize = 3;
const DEFAULTS: [u16; 7] = [0x2403, 0x0500, 0x0510, 0x0F0E, 0, 0, 0x0600];

const RESET_DONE: u16 = 0xFF24;
const LOCKED: u16 = 0x8000;
const BAD_CRC: u16 = 0x1000;
const WAS_RESET: u16 = 0x0400;
const ALL_NEW: u16 = 0x000F;
const DEMANDS_CRC: u16 = 0x1000;

/// What the converter answers with in its next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Response {
    /// The status as it is when the frame begins.
    Status,
    Word(u16),
}

/// Counts of the four channels at a time, seconds.
pub type Signal = Box<dyn FnMut(f64) -> [i32; 4]>;

/// The converter.
pub struct Converter {
    registers: [u16; 7],
    signal: Signal,
    counts: [i32; 4],
    next_fs: u64,
    response: Response,
    is_selected: bool,
    outgoing: [u8; FRAME_BYTES],
    incoming: Vec<u8>,
    is_locked: bool,
    /// Level of its data-ready pin.
    pub is_ready_high: bool,
    /// One bit of this frame, counted from now, comes wrong.
    pub damaged_frame: Option<u32>,
    /// Conversions that were ready since power came.
    pub conversions: u64,
}

impl Converter {
    /// Just powered.
    pub fn new(signal: impl FnMut(f64) -> [i32; 4] + 'static) -> Self {
        Self {
            registers: DEFAULTS,
            signal: Box::new(signal),
            counts: [0; 4],
            next_fs: 0,
            response: Response::Word(RESET_DONE),
            is_selected: false,
            outgoing: [0; FRAME_BYTES],
            incoming: Vec::new(),
            is_locked: false,
            is_ready_high: true,
            damaged_frame: None,
            conversions: 0,
        }
    }

    /// When the next conversion is ready.
    pub fn due_fs(&self) -> u64 {
        self.next_fs
    }

    /// The conversion of now: the data-ready pin falls.
    pub fn convert(&mut self, now_fs: u64) {
        self.counts = (self.signal)(crate::time::seconds(now_fs));
        self.registers[STATUS] |= ALL_NEW;
        self.conversions += 1;
        let oversampling = 128 << (self.registers[CLOCK] >> 2 & 7);
        self.next_fs = now_fs + fs(f64::from(oversampling) / (CLOCK_HZ / 2.0));
        self.is_ready_high = false;
    }

    /// Level of its chip select.
    pub fn select(&mut self, is_low: bool) {
        if is_low && !self.is_selected {
            self.begin_frame();
        } else if !is_low && self.is_selected && !self.incoming.is_empty() {
            self.end_frame();
        }
        self.is_selected = is_low;
    }

    /// Eight clocks.
    pub fn clock(&mut self, sent: u8) -> u8 {
        if !self.is_selected {
            return 0xFF;
        }
        self.is_ready_high = true;
        let answer = self.outgoing.get(self.incoming.len()).copied().unwrap_or(0);
        self.incoming.push(sent);
        answer
    }

    /// It loses its set-up, as after a dip of its supply.
    pub fn lose_power(&mut self) {
        self.reset();
        self.registers[STATUS] = 0x0500;
        self.response = Response::Status;
    }

    fn begin_frame(&mut self) {
        self.incoming.clear();
        self.outgoing = [0; FRAME_BYTES];
        let response = match self.response {
            Response::Status => self.registers[STATUS],
            Response::Word(word) => word,
        };
        self.outgoing[..2].copy_from_slice(&response.to_be_bytes());
        for (bytes, counts) in self.outgoing[3..15].chunks_exact_mut(3).zip(self.counts) {
            bytes.copy_from_slice(&counts.to_be_bytes()[1..]);
        }
        let crc = CRC.checksum(&self.outgoing[..15]);
        self.outgoing[15..17].copy_from_slice(&crc.to_be_bytes());
        if let Some(left) = self.damaged_frame {
            self.damaged_frame = left.checked_sub(1);
            self.outgoing[4] ^= u8::from(left == 0);
        }
    }

    fn end_frame(&mut self) {
        if self.incoming.len() < FRAME_BYTES {
            return;
        }
        let word = |at: usize| u16::from_be_bytes([self.incoming[3 * at], self.incoming[3 * at + 1]]);
        let (command, value) = (word(0), word(1));
        let words = if command & 0xE000 == 0x6000 { 2 } else { 1 };
        let crc_fits = CRC.checksum(&self.incoming[..3 * words]) == word(words);
        self.registers[STATUS] &= !(ALL_NEW | BAD_CRC);
        if self.registers[MODE] & DEMANDS_CRC != 0 && !crc_fits {
            self.registers[STATUS] |= BAD_CRC;
            self.response = Response::Status;
            return;
        }
        self.obey(command, value);
    }

    fn obey(&mut self, command: u16, value: u16) {
        let register = usize::from(command >> 7 & 0x3F);
        match command {
            0x0011 if !self.is_locked => self.reset(),
            0x0555 => self.lock(true),
            0x0655 => self.lock(false),
            _ if command & 0xE000 == 0xA000 => {
                self.response = Response::Word(self.registers.get(register).copied().unwrap_or(0));
            }
            _ if command & 0xE000 == 0x6000 && !self.is_locked => self.write(register, value, command),
            _ => self.response = Response::Status,
        }
    }

    fn reset(&mut self) {
        self.registers = DEFAULTS;
        self.is_locked = false;
        self.response = Response::Word(RESET_DONE);
    }

    fn lock(&mut self, locks: bool) {
        self.is_locked = locks;
        self.registers[STATUS] = self.registers[STATUS] & !LOCKED | if locks { LOCKED } else { 0 };
        self.response = Response::Word(if locks { 0x0555 } else { 0x0655 });
    }

    fn write(&mut self, register: usize, value: u16, command: u16) {
        if let Some(held) = self.registers.get_mut(register).filter(|_| register > STATUS) {
            *held = value;
        }
        if register == MODE && value & WAS_RESET == 0 {
            self.registers[STATUS] &= !WAS_RESET;
        }
        self.response = Response::Word(command & 0x1FFF | 0x4000);
    }
}
