//! One SPI controller as master of eight-bit frames (RM0090, 28).

use crate::time::{NEVER_FS, period_fs};

const SECOND_EDGE: u32 = 1;
const IDLE_HIGH: u32 = 1 << 1;
const MASTER: u32 = 1 << 2;
const ON: u32 = 1 << 6;
/// Least significant bit first, 16-bit frames, one wire for both directions: nothing here knows them.
const UNKNOWN: u32 = 1 << 7 | 1 << 11 | 1 << 13 | 1 << 15;

const RECEIVED: u32 = 1;
const EMPTY: u32 = 1 << 1;
const OVERRUN: u32 = 1 << 6;
const BUSY: u32 = 1 << 7;

/// The registers.
#[derive(Clone, Debug, Default)]
pub struct Spi {
    control: u32,
    control_2: u32,
    received: Option<u8>,
    is_overrun: bool,
    waiting: Option<u8>,
    shifting: Option<(u64, u8)>,
}

/// How bits are put on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mode {
    /// The clock is high when idle.
    pub is_idle_high: bool,
    /// Data are taken on the second edge.
    pub is_second_edge: bool,
}

impl Spi {
    /// Read a register.
    pub fn read(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            0x00 => self.control,
            0x04 => self.control_2,
            0x08 => self.status(),
            0x0C => self.read_data(),
            0x1C | 0x20 => 0,
            _ => return None,
        })
    }

    /// Write a register. The bus that drives it runs at `bus_hz`.
    pub fn write(&mut self, offset: u32, value: u32, now_fs: u64, bus_hz: f64) -> Option<()> {
        match offset {
            0x00 if value & UNKNOWN == 0 => self.control = value,
            0x04 if value & !0x04 == 0 => self.control_2 = value,
            0x0C => self.send(value as u8, now_fs, bus_hz),
            0x1C if value == 0 => {}
            _ => return None,
        }
        Some(())
    }

    /// Its clock, Hz.
    pub fn hz(&self, bus_hz: f64) -> f64 {
        bus_hz / f64::from(2 << (self.control >> 3 & 7))
    }

    /// How it puts bits on the wire.
    pub fn mode(&self) -> Mode {
        Mode { is_idle_high: self.control & IDLE_HIGH != 0, is_second_edge: self.control & SECOND_EDGE != 0 }
    }

    /// Whether a program that looks at the status now waits for something to come.
    pub fn is_waited_for(&self) -> bool {
        self.shifting.is_some() && self.received.is_none()
    }

    /// When the byte that is being sent is over.
    pub fn due_fs(&self) -> u64 {
        self.shifting.map_or(NEVER_FS, |(end_fs, _)| end_fs)
    }

    /// A byte that is over by now: when, and what was sent.
    pub fn finished(&self, now_fs: u64) -> Option<(u64, u8)> {
        self.shifting.filter(|(end_fs, _)| *end_fs <= now_fs)
    }

    /// What came in while that byte went out; the next begins.
    pub fn finish(&mut self, end_fs: u64, byte: u8, bus_hz: f64) {
        self.is_overrun |= self.received.is_some();
        self.received.get_or_insert(byte);
        self.shifting = self.waiting.take().map(|next| (end_fs + self.byte_fs(bus_hz), next));
    }

    fn byte_fs(&self, bus_hz: f64) -> u64 {
        8 * period_fs(self.hz(bus_hz))
    }

    fn send(&mut self, byte: u8, now_fs: u64, bus_hz: f64) {
        if self.control & (ON | MASTER) != ON | MASTER {
            return;
        }
        if self.shifting.is_none() {
            self.shifting = Some((now_fs + self.byte_fs(bus_hz), byte));
        } else {
            self.waiting = Some(byte);
        }
    }

    fn read_data(&mut self) -> u32 {
        self.is_overrun = false;
        self.received.take().unwrap_or(0).into()
    }

    fn status(&self) -> u32 {
        let received = if self.received.is_some() { RECEIVED } else { 0 };
        let empty = if self.waiting.is_none() { EMPTY } else { 0 };
        let overrun = if self.is_overrun { OVERRUN } else { 0 };
        let busy = if self.shifting.is_some() { BUSY } else { 0 };
        received | empty | overrun | busy
    }
}
