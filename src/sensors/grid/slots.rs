//! Epochs under way, oldest first.

use super::Reading;

/// Epochs under way at most: one ahead, and as many as the longest delays span.
const CAPACITY: usize = 12;

/// One epoch under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    pub(super) tick: u32,
    pub(super) instant_us: i64,
    pub(super) reading: Option<Reading>,
    pub(super) offset_us: i32,
    pub(super) duplicates: u8,
    pub(super) off_time: bool,
    pub(super) relocked: bool,
}

impl Slot {
    pub(super) const fn new(tick: u32, instant_us: i64) -> Self {
        Self { tick, instant_us, reading: None, offset_us: 0, duplicates: 0, off_time: false, relocked: false }
    }

    /// Take a reading, or of two the one nearer to the epoch's instant. False when it is not the first.
    pub(super) fn offer(&mut self, reading: &Reading, offset_us: i32) -> bool {
        let first = self.reading.is_none();
        if first || offset_us.unsigned_abs() < self.offset_us.unsigned_abs() {
            (self.reading, self.offset_us) = (Some(*reading), offset_us);
        }
        if !first {
            self.duplicates = self.duplicates.saturating_add(1);
        }
        first
    }
}

/// The epochs under way.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    slots: [Slot; CAPACITY],
    length: usize,
}

impl Slots {
    pub(super) const fn new() -> Self {
        Self { slots: [Slot::new(0, 0); CAPACITY], length: 0 }
    }

    pub(super) fn is_full(&self) -> bool {
        self.length == CAPACITY
    }

    /// False when there is no room.
    pub(super) fn push(&mut self, slot: Slot) -> bool {
        let Some(place) = self.slots.get_mut(self.length) else { return false };
        *place = slot;
        self.length += 1;
        true
    }

    /// The oldest epoch, if its instant is not after `due_us`.
    pub(super) fn pop_until(&mut self, due_us: i64) -> Option<Slot> {
        let oldest = *self.slots.get(..self.length)?.first()?;
        if oldest.instant_us > due_us {
            return None;
        }
        self.slots.copy_within(1..self.length, 0);
        self.length -= 1;
        Some(oldest)
    }

    /// The epoch nearest to an instant, and the instant less the epoch's own.
    pub(super) fn nearest(&mut self, instant_us: i64) -> Option<(&mut Slot, i64)> {
        let slot =
            self.slots.get_mut(..self.length)?.iter_mut().min_by_key(|slot| (slot.instant_us - instant_us).abs())?;
        let offset_us = instant_us - slot.instant_us;
        Some((slot, offset_us))
    }

    /// Drop the epochs from `instant_us` on, and return the tick of the first of them.
    pub(super) fn drop_from(&mut self, instant_us: i64) -> Option<u32> {
        let kept = self.slots.iter().take(self.length).take_while(|slot| slot.instant_us < instant_us).count();
        let first = self.slots.get(..self.length)?.get(kept).map(|slot| slot.tick);
        self.length = kept;
        first
    }
}
