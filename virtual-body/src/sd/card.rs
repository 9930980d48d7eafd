//! The card: power, chip select, and bytes in and out.

use super::answers::{ACCEPTED, DATA_CRC, NOT_WRITTEN, STOP_TOKEN, TOKEN, TOKEN_OF_SEVERAL, data_crc};
use crate::disk::Disk;
use embedded_sdmmc::{Block, BlockDevice, BlockIdx};
use std::collections::VecDeque;

/// Clocks with chip select high that a card wants after power-up.
const POWER_UP_CLOCKS: u32 = 74;
/// The fastest clock while a card starts, Hz.
const START_HZ: u32 = 400_000;
/// The fastest clock in default speed mode, Hz.
const DATA_HZ: u32 = 25_000_000;
/// From power-up to the end of ACMD41, nanoseconds.
pub(super) const START_NS: u64 = 150_000_000;
/// From a command to its data, nanoseconds.
pub(super) const READ_NS: u64 = 100_000;
/// Busy after a block that is written alone, and after each of several, nanoseconds.
const WRITE_NS: u64 = 800_000;
const WRITE_OF_SEVERAL_NS: u64 = 100_000;

/// How a card is addressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capacity {
    /// SDSC: up to 2 GB, addressed by the byte.
    Standard,
    /// SDHC, SDXC: addressed by the block.
    High,
}

/// How far the card is with starting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// It has power, and has seen no CMD0.
    PowerUp,
    /// CMD0 has put it into SPI mode.
    Idle,
    /// ACMD41 has begun, and is over at this time, ns.
    Starting(u64),
    /// It takes blocks.
    Ready,
}

/// What it does with what comes in.
#[derive(Clone, Debug)]
pub(super) enum Traffic {
    /// Commands.
    Commands,
    /// A block, or several, to be written from this address on; what has come of the present one.
    Writing { block: u32, several: bool, data: Vec<u8> },
    /// It sends blocks until it is told to stop.
    Reading { next: u32 },
}

/// A card with its contents.
pub struct SdCard {
    pub(super) capacity: Capacity,
    /// What is on it.
    pub disk: Disk,
    pub(super) phase: Phase,
    pub(super) clocks_unselected: u32,
    pub(super) checks_crc: bool,
    pub(super) is_app_command: bool,
    pub(super) command: Vec<u8>,
    /// What it sends, each byte not before its time, ns.
    pub(super) out: VecDeque<(u64, u8)>,
    pub(super) traffic: Traffic,
    pub(super) busy_until_ns: u64,
    /// The block that it was given last, which is safe when it is no longer busy.
    programming: Option<u32>,
    pub(super) is_read_only: bool,
    pub(super) write_fails: bool,
    pub(super) read_fails: bool,
    pub(super) status: u8,
    /// How long it will be busy with the next block beyond the usual, ns.
    pub(super) stall_ns: u64,
}

impl SdCard {
    pub fn new(disk: Disk, capacity: Capacity) -> Self {
        Self {
            capacity,
            disk,
            phase: Phase::PowerUp,
            clocks_unselected: 0,
            checks_crc: false,
            is_app_command: false,
            command: Vec::new(),
            out: VecDeque::new(),
            traffic: Traffic::Commands,
            busy_until_ns: 0,
            programming: None,
            is_read_only: false,
            write_fails: false,
            read_fails: false,
            status: 0,
            stall_ns: 0,
        }
    }

    /// The power goes, and comes back at some time: what the card lies about, or is writing just now, suffers.
    pub fn lose_power(&mut self, now_ns: u64) {
        self.disk.lose_power(self.programming.filter(|_| now_ns < self.busy_until_ns));
        let disk = std::mem::replace(&mut self.disk, Disk::new(0));
        let (capacity, is_read_only) = (self.capacity, self.is_read_only);
        *self = Self { is_read_only, ..Self::new(disk, capacity) };
    }

    /// Eight clocks with chip select high.
    pub fn clock_unselected(&mut self, hz: u32) {
        if hz <= START_HZ {
            self.clocks_unselected += 8;
        }
        self.command.clear();
        self.out.clear();
        if matches!(self.traffic, Traffic::Reading { .. }) {
            self.traffic = Traffic::Commands;
        }
    }

    /// Eight clocks with chip select low: a byte in, a byte out.
    pub fn clock(&mut self, sent: u8, now_ns: u64, hz: u32) -> u8 {
        let limit_hz = if self.phase == Phase::Ready { DATA_HZ } else { START_HZ };
        if hz > limit_hz || self.clocks_unselected < POWER_UP_CLOCKS {
            return 0xff;
        }
        let answer = self.answer(now_ns);
        match self.traffic {
            Traffic::Writing { .. } if self.out.is_empty() => self.take_data(sent, now_ns),
            Traffic::Writing { .. } => {}
            _ => self.take_command(sent, now_ns),
        }
        answer
    }

    fn answer(&mut self, now_ns: u64) -> u8 {
        if let Some(&(at_ns, byte)) = self.out.front() {
            if now_ns < at_ns {
                return 0xff;
            }
            self.out.pop_front();
            return byte;
        }
        if let Traffic::Reading { next } = self.traffic {
            self.send_block(next, now_ns);
            self.traffic = Traffic::Reading { next: next + 1 };
        }
        if now_ns < self.busy_until_ns { 0 } else { 0xff }
    }

    pub(super) fn send(&mut self, at_ns: u64, bytes: &[u8]) {
        self.out.extend(bytes.iter().map(|&byte| (at_ns, byte)));
    }

    /// A block with its token and CRC, or the token of an error.
    pub(super) fn send_block(&mut self, index: u32, now_ns: u64) {
        let mut block = [Block::new()];
        if std::mem::take(&mut self.read_fails) || self.disk.read(&mut block, BlockIdx(index)).is_err() {
            return self.send(now_ns + READ_NS, &[super::answers::ERROR_TOKEN]);
        }
        self.send_data(&block[0].contents, now_ns);
    }

    /// Data with their token and CRC.
    pub(super) fn send_data(&mut self, data: &[u8], now_ns: u64) {
        let at_ns = now_ns + READ_NS;
        self.send(at_ns, &[TOKEN]);
        self.send(at_ns, data);
        self.send(at_ns, &data_crc(data));
    }

    fn take_command(&mut self, sent: u8, now_ns: u64) {
        if now_ns < self.busy_until_ns || (self.command.is_empty() && sent & 0xc0 != 0x40) {
            return;
        }
        self.command.push(sent);
        if let Ok(command) = <[u8; 6]>::try_from(self.command.as_slice()) {
            self.command.clear();
            self.obey(&command, now_ns);
        }
    }

    fn take_data(&mut self, sent: u8, now_ns: u64) {
        let Traffic::Writing { block, several, data } = &mut self.traffic else { return };
        if data.is_empty() {
            match sent {
                STOP_TOKEN if *several => self.traffic = Traffic::Commands,
                TOKEN if !*several => data.push(sent),
                TOKEN_OF_SEVERAL if *several => data.push(sent),
                _ => {}
            }
            return;
        }
        data.push(sent);
        if data.len() < 515 {
            return;
        }
        let (index, several) = (*block, *several);
        let data = std::mem::take(data);
        let answer = self.store(index, &data[1..]);
        self.traffic =
            if several { Traffic::Writing { block: index + 1, several, data: Vec::new() } } else { Traffic::Commands };
        self.send(now_ns, &[answer]);
        self.programming = Some(index);
        let usual_ns = if several { WRITE_OF_SEVERAL_NS } else { WRITE_NS };
        self.busy_until_ns = now_ns + usual_ns + std::mem::take(&mut self.stall_ns);
    }

    fn store(&mut self, index: u32, data: &[u8]) -> u8 {
        let (contents, crc) = data.split_at(512);
        if self.checks_crc && crc != data_crc(contents) {
            return DATA_CRC;
        }
        let block = Block { contents: contents.try_into().unwrap() };
        let fails = self.is_read_only || std::mem::take(&mut self.write_fails);
        if fails || self.disk.write(&[block], BlockIdx(index)).is_err() {
            self.status = 0x04;
            return NOT_WRITTEN;
        }
        ACCEPTED
    }
}
