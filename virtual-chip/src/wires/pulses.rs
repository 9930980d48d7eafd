//! The pulse per second of a GPS receiver.

use crate::time::NEVER_FS;

/// Rising edges in a period.
#[derive(Clone, Copy, Debug)]
pub struct Pulses {
    next_fs: u64,
    period_fs: u64,
}

impl Default for Pulses {
    /// None.
    fn default() -> Self {
        Self { next_fs: NEVER_FS, period_fs: 0 }
    }
}

impl Pulses {
    /// From `first_fs` on.
    pub fn new(first_fs: u64, period_fs: u64) -> Self {
        Self { next_fs: first_fs, period_fs }
    }

    /// When the next comes.
    pub fn due_fs(&self) -> u64 {
        self.next_fs
    }

    /// When one came that was due by now.
    pub fn take(&mut self, now_fs: u64) -> Option<u64> {
        let at_fs = self.next_fs;
        (at_fs <= now_fs).then(|| {
            self.next_fs += self.period_fs;
            at_fs
        })
    }
}
