//! One UART (RM0090, 30), as far as it sends and receives eight bits without parity.

use crate::clocks::Moment;
use crate::time::{NEVER_FS, period_fs};
use crate::wires::serial::{Line, Sent};

const FRAMING: u32 = 1 << 1;
const OVERRUN: u32 = 1 << 3;
const RECEIVED: u32 = 1 << 5;
const COMPLETE: u32 = 1 << 6;
const EMPTY: u32 = 1 << 7;
const ERRORS: u32 = 0b1111;

const RECEIVER_ON: u32 = 1 << 2;
const TRANSMITTER_ON: u32 = 1 << 3;
const ON: u32 = 1 << 13;
const BY_EIGHT: u32 = 1 << 15;

/// Bits of a byte on the wire, with start and stop.
const BITS: u64 = 10;

/// What a receiver bears of difference between its own rate and that of the sender.
const TOLERANCE: f64 = 0.04;

/// The registers, and the wires of the two pins.
pub struct Usart {
    errors: u32,
    received: Option<u8>,
    has_read_status: bool,
    divisor: u32,
    control: [u32; 3],
    guard: u32,
    waiting: Option<u8>,
    shifting: Option<(u64, u8)>,
    /// What comes in.
    pub line: Line,
    /// What has gone out.
    pub sent: Vec<Sent>,
    /// Bytes that were written while another still waited, and so were lost.
    pub overwritten: u32,
}

impl Usart {
    /// After a reset, with these wires.
    pub fn new(line: Line) -> Self {
        Self {
            errors: 0,
            received: None,
            has_read_status: false,
            divisor: 0,
            control: [0; 3],
            guard: 0,
            waiting: None,
            shifting: None,
            line,
            sent: Vec::new(),
            overwritten: 0,
        }
    }

    /// A reset: the wires stay, and what they have carried.
    pub fn reset(&mut self) {
        let line = std::mem::take(&mut self.line);
        let sent = std::mem::take(&mut self.sent);
        *self = Self { sent, overwritten: self.overwritten, ..Self::new(line) };
    }

    /// Read a register.
    pub fn read(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            0x00 => {
                self.has_read_status = true;
                self.status()
            }
            0x04 => {
                if std::mem::take(&mut self.has_read_status) {
                    self.errors = 0;
                }
                self.received.take().unwrap_or(0).into()
            }
            0x08 => self.divisor,
            0x0C..=0x14 => self.control[(offset as usize - 0x0C) / 4],
            0x18 => self.guard,
            _ => return None,
        })
    }

    /// Write a register. The bus that drives it runs at `bus_hz`.
    pub fn write(&mut self, offset: u32, value: u32, now: Moment, bus_hz: f64) -> Option<()> {
        match offset {
            0x00 => {}
            0x04 => self.send(value as u8, now.fs, bus_hz),
            0x08 => self.divisor = value & 0xFFFF,
            0x0C..=0x14 => self.control[(offset as usize - 0x0C) / 4] = value,
            0x18 => self.guard = value,
            _ => return None,
        }
        Some(())
    }

    /// Whether its interrupt is wanted.
    pub fn wants_interrupt(&self) -> bool {
        let status = self.status();
        let receives = self.control[0] & RECEIVED != 0 && status & (RECEIVED | OVERRUN) != 0;
        receives || status & self.control[0] & (EMPTY | COMPLETE) != 0
    }

    /// When a byte is over, on either wire.
    pub fn due_fs(&self) -> u64 {
        self.shifting.map_or(NEVER_FS, |(end_fs, _)| end_fs).min(self.line.due_fs())
    }

    /// Bytes that are over by now. What goes out is heard only through the right pins.
    pub fn elapse(&mut self, now_fs: u64, bus_hz: f64, has_pins: [bool; 2]) {
        while let Some((end_fs, byte)) = self.shifting.filter(|(end_fs, _)| *end_fs <= now_fs) {
            if has_pins[0] {
                self.sent.push(Sent { byte, baud: self.baud(bus_hz) });
            }
            self.shifting = self.waiting.take().map(|byte| (end_fs + self.byte_fs(bus_hz), byte));
        }
        while let Some(byte) = self.line.take(now_fs) {
            if has_pins[1] {
                self.receive(byte, bus_hz);
            }
        }
    }

    /// Its rate with this clock, baud; 0 while it is off.
    pub fn baud(&self, bus_hz: f64) -> f64 {
        let (mantissa, fraction) = (f64::from(self.divisor >> 4), f64::from(self.divisor & 0xF));
        let ticks =
            if self.control[0] & BY_EIGHT != 0 { 8.0 * mantissa + fraction } else { 16.0 * mantissa + fraction };
        if ticks > 0.0 && self.control[0] & ON != 0 { bus_hz / ticks } else { 0.0 }
    }

    fn byte_fs(&self, bus_hz: f64) -> u64 {
        BITS * period_fs(self.baud(bus_hz))
    }

    fn status(&self) -> u32 {
        let received = if self.received.is_some() { RECEIVED } else { 0 };
        let empty = if self.waiting.is_none() { EMPTY } else { 0 };
        let complete = if self.shifting.is_none() { COMPLETE } else { 0 };
        self.errors | received | empty | complete
    }

    fn send(&mut self, byte: u8, now_fs: u64, bus_hz: f64) {
        if self.control[0] & TRANSMITTER_ON == 0 || self.baud(bus_hz) == 0.0 {
            return;
        }
        if self.shifting.is_none() {
            self.shifting = Some((now_fs + self.byte_fs(bus_hz), byte));
        } else if self.waiting.replace(byte).is_some() {
            self.overwritten += 1;
        }
    }

    fn receive(&mut self, byte: u8, bus_hz: f64) {
        let baud = self.baud(bus_hz);
        if self.control[0] & RECEIVER_ON == 0 || baud == 0.0 {
            return;
        }
        if self.received.is_some() {
            self.errors |= OVERRUN;
            return;
        }
        let is_readable = (baud / self.line.baud - 1.0).abs() < TOLERANCE;
        self.received = Some(if is_readable { byte } else { !byte });
        self.errors = self.errors & ERRORS | if is_readable { 0 } else { FRAMING };
    }
}
