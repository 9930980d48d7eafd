//! What the card does when it is told to.

use super::answers::{BAD_ADDRESS, BAD_CRC, IDLE, ILLEGAL, command_crc_fits};
use super::card::{Capacity, Phase, START_NS, SdCard, Traffic};
use super::size::card_specific_data;

impl SdCard {
    pub(super) fn obey(&mut self, command: &[u8; 6], now_ns: u64) {
        let number = command[0] & 0x3f;
        let argument = u32::from_be_bytes([command[1], command[2], command[3], command[4]]);
        // CMD0 and CMD8 are always checked; CMD0 before SPI mode is the SD bus's own.
        let is_checked = self.checks_crc || number == 0 || number == 8;
        if is_checked && !command_crc_fits(command) {
            if self.phase != Phase::PowerUp {
                self.reply(now_ns, &[BAD_CRC]);
            }
            return;
        }
        if number == 0 {
            (self.phase, self.checks_crc, self.traffic) = (Phase::Idle, false, Traffic::Commands);
            self.out.clear();
            return self.reply(now_ns, &[IDLE]);
        }
        if let Phase::Starting(end_ns) = self.phase
            && now_ns >= end_ns
        {
            self.phase = Phase::Ready;
        }
        let is_app_command = std::mem::take(&mut self.is_app_command);
        match self.phase {
            Phase::PowerUp => {}
            Phase::Idle | Phase::Starting(_) => self.obey_idle(number, argument, is_app_command, now_ns),
            Phase::Ready => self.obey_ready(number, argument, is_app_command, now_ns),
        }
    }

    /// One byte of gap, as every card leaves at least, then the answer.
    fn reply(&mut self, now_ns: u64, answer: &[u8]) {
        self.send(now_ns, &[0xff]);
        self.send(now_ns, answer);
    }

    fn obey_idle(&mut self, number: u8, argument: u32, is_app_command: bool, now_ns: u64) {
        match (number, is_app_command) {
            (8, false) => self.reply(now_ns, &[IDLE, 0, 0, 1, argument as u8]),
            (59, false) => {
                self.checks_crc = argument & 1 == 1;
                self.reply(now_ns, &[IDLE]);
            }
            (55, false) => {
                self.is_app_command = true;
                self.reply(now_ns, &[IDLE]);
            }
            (41, true) => {
                // A card of high capacity does not start for a host that does not say that it knows such cards.
                let is_known = self.capacity == Capacity::Standard || argument & 0x4000_0000 != 0;
                if self.phase == Phase::Idle && is_known {
                    self.phase = Phase::Starting(now_ns + START_NS);
                }
                self.reply(now_ns, &[IDLE]);
            }
            _ => self.reply(now_ns, &[IDLE | ILLEGAL]),
        }
    }

    fn obey_ready(&mut self, number: u8, argument: u32, is_app_command: bool, now_ns: u64) {
        match (number, is_app_command) {
            (55, false) => {
                self.is_app_command = true;
                self.reply(now_ns, &[0]);
            }
            (41 | 23, true) => self.reply(now_ns, &[0]),
            (58, false) => {
                let high = if self.capacity == Capacity::High { 0xc0 } else { 0x80 };
                self.reply(now_ns, &[0, high, 0xff, 0x80, 0]);
            }
            (13, false) => {
                let status = std::mem::take(&mut self.status);
                self.reply(now_ns, &[0, status]);
            }
            (12, false) => {
                self.traffic = Traffic::Commands;
                self.out.clear();
                self.reply(now_ns, &[0xff, 0]);
            }
            (9, false) => {
                self.reply(now_ns, &[0]);
                self.send_data(&card_specific_data(self.capacity, self.disk.block_count()), now_ns);
            }
            (17 | 18 | 24 | 25, false) => self.begin_blocks(number, argument, now_ns),
            (59, false) => self.reply(now_ns, &[0]),
            _ => self.reply(now_ns, &[ILLEGAL]),
        }
    }

    fn begin_blocks(&mut self, number: u8, argument: u32, now_ns: u64) {
        let block = match self.capacity {
            Capacity::High => Some(argument),
            Capacity::Standard => Some(argument / 512).filter(|_| argument.is_multiple_of(512)),
        };
        let Some(block) = block.filter(|&block| block < self.disk.block_count()) else {
            return self.reply(now_ns, &[BAD_ADDRESS]);
        };
        self.reply(now_ns, &[0]);
        match number {
            17 => self.send_block(block, now_ns),
            18 => self.traffic = Traffic::Reading { next: block },
            _ => self.traffic = Traffic::Writing { block, several: number == 25, data: Vec::new() },
        }
    }
}
