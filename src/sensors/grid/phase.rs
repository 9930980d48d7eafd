//! Where the epochs lie: a phase lock on the scalar sensor's readings.

use super::slots::Slot;
use crate::epoch::EPOCH_US;

/// Readings in a row that keep another phase before the grid is moved to it.
pub const RELOCK_READINGS: u8 = 10;

/// Times in here have this many bits after the point: a rounding of a whole microsecond would be 10 ppm.
const FRACTION_BITS: u32 = 16;

/// An offset moves the next epoch by 1/16 of itself and the period by 1/1024: critically damped, with a time constant of
/// 32 epochs, and a white jitter of the readings moves the grid by a fifth of itself.
const PHASE_GAIN_BITS: u32 = 4;
const PERIOD_GAIN_BITS: u32 = 10;

/// The period stays within 1,000 ppm of the nominal one, whatever comes in.
const LARGEST_PERIOD_ERROR: i64 = (EPOCH_US as i64 / 1_000) << FRACTION_BITS;

const NOMINAL_PERIOD: i64 = (EPOCH_US as i64) << FRACTION_BITS;

/// Instant and tick of the next epoch to be opened.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phase {
    next: i64,
    next_tick: u32,
    period: i64,
    locked: bool,
    off_time: u8,
    last_off_time_us: i64,
}

impl Phase {
    /// An unlocked grid whose first epoch is at `first_us`.
    pub(super) fn new(first_us: i64) -> Self {
        let next = first_us << FRACTION_BITS;
        Self { next, next_tick: 0, period: NOMINAL_PERIOD, locked: false, off_time: 0, last_off_time_us: first_us }
    }

    pub(super) fn is_locked(&self) -> bool {
        self.locked
    }

    pub(super) fn next_us(&self) -> i64 {
        self.next >> FRACTION_BITS
    }

    pub(super) fn next_tick(&self) -> u32 {
        self.next_tick
    }

    pub(super) fn period_error_ppm(&self) -> f32 {
        (self.period - NOMINAL_PERIOD) as f32 / (NOMINAL_PERIOD / 1_000_000) as f32
    }

    /// Open the next epoch.
    pub(super) fn open(&mut self) -> Slot {
        let slot = Slot::new(self.next_tick, self.next_us());
        self.next += self.period;
        self.next_tick = self.next_tick.wrapping_add(1);
        slot
    }

    /// Put an epoch of this tick at `instant_us`, which the sensor's period is kept for.
    pub(super) fn lock(&mut self, instant_us: i64, tick: u32) {
        (self.next, self.next_tick) = (instant_us << FRACTION_BITS, tick);
        (self.locked, self.off_time) = (true, 0);
    }

    /// A reading came within the tolerance of its epoch: the phase is still this one.
    pub(super) fn on_time(&mut self) {
        self.off_time = 0;
    }

    /// The reading of an epoch lies `offset_us` after it, within the tolerance.
    pub(super) fn follow(&mut self, offset_us: i64) {
        let offset = offset_us << FRACTION_BITS;
        self.next += offset >> PHASE_GAIN_BITS;
        let period = self.period + (offset >> PERIOD_GAIN_BITS);
        let lowest = NOMINAL_PERIOD - LARGEST_PERIOD_ERROR;
        self.period = period.clamp(lowest, NOMINAL_PERIOD + LARGEST_PERIOD_ERROR);
    }

    /// A reading came off its time. True when enough in a row have kept whole periods between them: the sensor has
    /// another phase now.
    pub(super) fn off_time(&mut self, instant_us: i64, tolerance_us: u32) -> bool {
        let since = (instant_us - self.last_off_time_us) << FRACTION_BITS;
        // The period is within a fraction of the nominal one: here and below nothing is divided by zero.
        let periods = (since + self.period / 2).checked_div_euclid(self.period).unwrap_or(0);
        let deviation_us = (since - periods * self.period) >> FRACTION_BITS;
        let regular = periods >= 1 && deviation_us.abs() <= i64::from(tolerance_us);
        self.off_time = if regular { self.off_time.saturating_add(1) } else { 1 };
        self.last_off_time_us = instant_us;
        self.off_time >= RELOCK_READINGS
    }

    /// Leave out the epochs before `oldest_us`, and say how many.
    pub(super) fn skip_to(&mut self, oldest_us: i64) -> u32 {
        let behind = (oldest_us << FRACTION_BITS) - self.next;
        if behind <= 0 {
            return 0;
        }
        let skipped = behind.checked_div(self.period).unwrap_or(0);
        self.next += skipped * self.period;
        self.next_tick = self.next_tick.wrapping_add(skipped as u32);
        skipped as u32
    }
}
