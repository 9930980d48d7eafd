//! A serial wire into the chip, and what it hears of one that leads out.

use crate::time::{NEVER_FS, period_fs};
use std::collections::VecDeque;

/// Bits of a byte on the wire, with start and stop.
const BITS: u64 = 10;

/// A byte that has gone out.
#[derive(Clone, Copy, Debug)]
pub struct Sent {
    /// The byte.
    pub byte: u8,
    /// What it was sent with.
    pub baud: f64,
}

/// Says something again and again.
struct Talker {
    next_fs: u64,
    period_fs: u64,
    count: u64,
    sentence: Box<dyn FnMut(u64) -> Vec<u8>>,
}

/// A wire into the chip.
pub struct Line {
    /// The rate of who sends on it.
    pub baud: f64,
    bytes: VecDeque<(u64, u8)>,
    talker: Option<Talker>,
}

impl Default for Line {
    fn default() -> Self {
        Self::new(115_200.0)
    }
}

impl Line {
    /// A quiet wire.
    pub fn new(baud: f64) -> Self {
        Self { baud, bytes: VecDeque::new(), talker: None }
    }

    /// Somebody says `sentence`, which is given its number, from `first_fs` on in each period.
    pub fn talk(&mut self, first_fs: u64, period_fs: u64, sentence: impl FnMut(u64) -> Vec<u8> + 'static) {
        self.talker = Some(Talker { next_fs: first_fs, period_fs, count: 0, sentence: Box::new(sentence) });
    }

    /// Nobody says anything more.
    pub fn fall_silent(&mut self) {
        self.talker = None;
    }

    /// Time begins anew: who talks goes on a period after that.
    pub fn restart_clock(&mut self) {
        self.bytes.clear();
        if let Some(talker) = &mut self.talker {
            talker.next_fs = talker.period_fs;
        }
    }

    /// Send these bytes from now on, after what is being sent.
    pub fn send(&mut self, now_fs: u64, bytes: &[u8]) {
        let mut end_fs = self.bytes.back().map_or(now_fs, |(end_fs, _)| now_fs.max(*end_fs));
        for &byte in bytes {
            end_fs += BITS * period_fs(self.baud);
            self.bytes.push_back((end_fs, byte));
        }
    }

    /// When the next byte is over, or somebody begins to talk.
    pub fn due_fs(&self) -> u64 {
        let byte_fs = self.bytes.front().map_or(NEVER_FS, |(end_fs, _)| *end_fs);
        byte_fs.min(self.talker.as_ref().map_or(NEVER_FS, |talker| talker.next_fs))
    }

    /// A byte that is over by now.
    pub fn take(&mut self, now_fs: u64) -> Option<u8> {
        while let Some(talker) = self.talker.as_mut().filter(|talker| talker.next_fs <= now_fs) {
            let (begin_fs, bytes) = (talker.next_fs, (talker.sentence)(talker.count));
            talker.count += 1;
            talker.next_fs += talker.period_fs;
            self.send(begin_fs, &bytes);
        }
        let (end_fs, byte) = *self.bytes.front()?;
        (end_fs <= now_fs).then(|| {
            self.bytes.pop_front();
            byte
        })
    }
}
