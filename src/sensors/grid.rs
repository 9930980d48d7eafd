//! Puts both sensors on the 10 Hz grid of the [`Epoch`]s.
//!
//! The grid follows the scalar sensor's own clock: a second-order phase lock on the instants of its readings (less their
//! known delay) sets where the epochs lie, and the fluxgate, which has 25 conversions to an epoch, is averaged around
//! exactly there. A grid on the microcontroller's clock would run against the sensor's: at 100 ppm a reading would
//! be lost or doubled every 17 minutes, and scalar and vector would be up to 50 ms apart, which looks like a false eddy
//! current. Readings stay in the middle of their epochs, so that jitter cannot move one to the next.
//!
//! The scalar sensor shall be set to 10 Hz. At a whole multiple of it the reading nearest to each epoch is taken and the
//! others are counted as doubled or off their time; what lies above 5 Hz then folds into the band. Other rates do not fit.
//!
//! Nothing is filled in. A missing reading makes an epoch without it; a second one, one off its time and one after its
//! epoch are dropped and counted. When the sensor comes back with another phase (restart, re-lock), the grid is moved to
//! it once it has kept it for [`RELOCK_READINGS`], and a tick is left out: the core sees a gap.

mod extended_timer;
mod phase;
mod slots;

pub use crate::epoch::EPOCH_US;
pub use phase::RELOCK_READINGS;

use super::decimator::{Decimator, DecimatorState, Mean, WindowFault};
use super::fluxgate::Fluxgate;
use super::scalar::{CHANNELS, Reading};
use super::{check, count};
use crate::epoch::Epoch;
use crate::settings::SettingsError;
use extended_timer::ExtendedTimer;
use phase::Phase;
use slots::{Slot, Slots};

/// After a silence longer than this, epochs are left out rather than made up.
const LONGEST_BACKLOG_US: i64 = 2_000_000;

/// Timing of both sensors. `build` turns it into a grid, once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridSettings {
    /// From the instant that a scalar reading stands for to the first byte of its sentence, microseconds, 0 to 400,000.
    pub scalar_delay_us: u32,
    /// From the instant that a conversion stands for to its data-ready, microseconds, 0 to 100,000.
    pub flux_delay_us: u32,
    /// How long after its first byte a sentence may come out of the parser, microseconds, 1,000 to 200,000. At 9600 baud a
    /// G-882 line takes 19,000.
    pub latency_us: u32,
    /// How far from its epoch a reading may lie, microseconds, 100 to 45,000; less than half the distance of the readings.
    pub tolerance_us: u32,
    /// Fluxgate conversions to an epoch, odd, 1 to 25.
    pub conversions_per_epoch: u8,
}

impl Default for GridSettings {
    /// G-882 at 9600 baud and the converter at 250 SPS. The delays are what the principle of the sensors suggests, no
    /// source gives them: a count over one cycle of 100 ms stands for its middle; a third-order sinc filter delays by
    /// one and a half conversions.
    fn default() -> Self {
        Self {
            scalar_delay_us: 50_000,
            flux_delay_us: 6_000,
            latency_us: 40_000,
            tolerance_us: 20_000,
            conversions_per_epoch: 25,
        }
    }
}

impl GridSettings {
    /// The grid, or which setting is wrong.
    pub fn build(&self, fluxgate: Fluxgate) -> Result<Grid, SettingsError> {
        check("scalar_delay_us", self.scalar_delay_us.into(), 0.0..=400_000.0, "0 to 400000")?;
        check("flux_delay_us", self.flux_delay_us.into(), 0.0..=100_000.0, "0 to 100000")?;
        check("latency_us", self.latency_us.into(), 1_000.0..=200_000.0, "1000 to 200000")?;
        check("tolerance_us", self.tolerance_us.into(), 100.0..=45_000.0, "100 to 45000")?;
        let decimator = Decimator::new(self.conversions_per_epoch)?;
        let scalar_us = self.scalar_delay_us + self.tolerance_us;
        let flux_us = self.flux_delay_us + decimator.group_delay_us();
        let close_after_us = i64::from(scalar_us.max(flux_us) + self.latency_us);
        Ok(Grid { settings: *self, close_after_us, decimator, fluxgate })
    }
}

/// What became of the scalar reading of an epoch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScalarMark {
    /// It is there and valid.
    Present,
    /// None came.
    Missing,
    /// It came, but the sensor or the limits call it invalid.
    Invalid,
    /// It came further from the epoch than the tolerance allows.
    OffTime,
}

/// What became of the fluxgate reading of an epoch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FluxMark {
    /// It is there.
    Present,
    /// Conversions of its window are missing or off their time.
    Missing,
    /// The converter reached its full scale in the window.
    Clipped,
}

/// How an epoch came about: for the log and the diagnosis, not for the core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpochMarks {
    /// Timer at the epoch's instant, microseconds.
    pub instant_us: u32,
    /// The scalar reading.
    pub scalar: ScalarMark,
    /// The fluxgate reading.
    pub flux: FluxMark,
    /// Further scalar readings in this epoch, all dropped but the one nearest to its instant.
    pub duplicates: u8,
    /// Whether the grid was moved to the scalar sensor's phase at this epoch.
    pub relocked: bool,
    /// Instant of the scalar reading less that of the epoch, microseconds; 0 without one.
    pub scalar_offset_us: i32,
    /// The scalar reading as it came, picotesla, when the sensor calls it invalid too.
    pub raw_scalar_pt: Option<i32>,
    /// Signal strength of the scalar sensor, in its own units.
    pub signal: Option<u32>,
    /// The scalar sensor's further channels, as it sent them.
    pub channels: [Option<u16>; CHANNELS],
    /// Battery current, mean over the epoch, ampere; missing together with the fluxgate reading.
    pub current_a: Option<f32>,
}

/// An epoch, and how it came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkedEpoch {
    /// What the core sees.
    pub epoch: Epoch,
    /// What the log keeps beside it.
    pub marks: EpochMarks,
}

/// What happened since the start. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridCounters {
    /// Epochs that came out.
    pub epochs: u32,
    /// Epochs without a scalar reading.
    pub scalar_missing: u32,
    /// Epochs with an invalid scalar reading.
    pub scalar_invalid: u32,
    /// Scalar readings further from their epoch than the tolerance.
    pub scalar_off_time: u32,
    /// Scalar readings that came when their epoch was closed.
    pub scalar_late: u32,
    /// Second, third ... scalar readings in one epoch.
    pub scalar_duplicates: u32,
    /// Epochs whose window lacks conversions.
    pub flux_missing: u32,
    /// Epochs whose window holds clipped conversions.
    pub flux_clipped: u32,
    /// Times that the grid was moved to the scalar sensor's phase; the first reading does it once.
    pub relocks: u32,
    /// Ticks left out, at a re-lock or after a silence.
    pub skipped: u32,
}

/// Epoch assembly: immutable configuration.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    settings: GridSettings,
    close_after_us: i64,
    decimator: Decimator,
    fluxgate: Fluxgate,
}

/// Epochs under way, the latest conversions, and the phase of the grid.
#[derive(Clone, Debug)]
pub struct GridState {
    timer: ExtendedTimer,
    phase: Option<Phase>,
    slots: Slots,
    conversions: DecimatorState,
    counters: GridCounters,
}

impl GridState {
    /// Before the first reading of any sensor.
    pub const fn new() -> Self {
        let counters = GridCounters {
            epochs: 0,
            scalar_missing: 0,
            scalar_invalid: 0,
            scalar_off_time: 0,
            scalar_late: 0,
            scalar_duplicates: 0,
            flux_missing: 0,
            flux_clipped: 0,
            relocks: 0,
            skipped: 0,
        };
        let (timer, slots) = (ExtendedTimer::new(), Slots::new());
        Self { timer, phase: None, slots, conversions: DecimatorState::new(), counters }
    }

    /// What happened since the start.
    pub fn counters(&self) -> &GridCounters {
        &self.counters
    }

    /// How much slower than the timer the scalar sensor's clock is, parts per million; 0 before its first reading.
    pub fn scalar_clock_ppm(&self) -> f32 {
        self.phase.as_ref().map_or(0.0, Phase::period_error_ppm)
    }
}

impl Default for GridState {
    fn default() -> Self {
        Self::new()
    }
}

impl Grid {
    /// From an epoch's instant until it comes out, microseconds; it waits for the later of the two sensors.
    pub fn close_after_us(&self) -> u32 {
        self.close_after_us as u32
    }

    /// One conversion of the three axes and the current, `ready_us` being the timer when it became ready.
    pub fn push_flux(&self, state: &mut GridState, counts: [i32; 4], ready_us: u32) {
        self.open_epochs(state, ready_us);
        state.conversions.push(counts, ready_us);
    }

    /// One reading of the scalar sensor, valid or not.
    pub fn push_scalar(&self, state: &mut GridState, reading: &Reading) {
        self.open_epochs(state, reading.last_byte_us);
        let first_byte_us = state.timer.at(reading.first_byte_us);
        let instant_us = first_byte_us - i64::from(self.settings.scalar_delay_us);
        let Some(phase) = &mut state.phase else { return };
        if !phase.is_locked() {
            return relock(state, instant_us, reading);
        }
        let Some((slot, offset_us)) = state.slots.nearest(instant_us) else { return };
        if offset_us.abs() > i64::from(EPOCH_US / 2 + EPOCH_US / 8) {
            return count(&mut state.counters.scalar_late);
        }
        if offset_us.abs() > i64::from(self.settings.tolerance_us) {
            count(&mut state.counters.scalar_off_time);
            slot.off_time = true;
            if phase.off_time(instant_us, self.settings.tolerance_us) {
                relock(state, instant_us, reading);
            }
            return;
        }
        phase.on_time();
        if !slot.offer(reading, offset_us as i32) {
            count(&mut state.counters.scalar_duplicates);
        }
    }

    /// The next epoch whose time is over at `now_us`, if any. Call it at least every 50 ms, until it returns none.
    pub fn poll(&self, state: &mut GridState, now_us: u32) -> Option<MarkedEpoch> {
        self.open_epochs(state, now_us);
        let due_us = state.timer.now_us() - self.close_after_us;
        let slot = state.slots.pop_until(due_us)?;
        // Only now is it known which reading is the nearest; a doubled one must not pull the grid.
        if let (Some(phase), Some(_)) = (&mut state.phase, slot.reading) {
            phase.follow(slot.offset_us.into());
        }
        let instant_us = slot.instant_us as u32; // the timer's own 32 bits
        let mean = self.decimator.mean_at(&state.conversions, instant_us.wrapping_add(self.settings.flux_delay_us));
        let marked = self.assemble(&slot, instant_us, mean);
        state.counters.count_epoch(&marked.marks);
        Some(marked)
    }

    /// Keep epochs open up to one period ahead of the timer.
    fn open_epochs(&self, state: &mut GridState, stamp_us: u32) {
        let now_us = state.timer.advance(stamp_us);
        let phase = state.phase.get_or_insert_with(|| Phase::new(now_us));
        let oldest_us = now_us - self.close_after_us - LONGEST_BACKLOG_US;
        let skipped = phase.skip_to(oldest_us);
        state.counters.skipped = state.counters.skipped.saturating_add(skipped);
        while phase.next_us() <= now_us + i64::from(EPOCH_US) && !state.slots.is_full() {
            state.slots.push(phase.open());
        }
    }

    fn assemble(&self, slot: &Slot, instant_us: u32, mean: Result<Mean, WindowFault>) -> MarkedEpoch {
        let scalar = match (slot.reading, slot.off_time) {
            (Some(reading), _) if reading.valid => ScalarMark::Present,
            (Some(_), _) => ScalarMark::Invalid,
            (None, true) => ScalarMark::OffTime,
            (None, false) => ScalarMark::Missing,
        };
        let flux = match mean {
            Ok(_) => FluxMark::Present,
            Err(WindowFault::Incomplete) => FluxMark::Missing,
            Err(WindowFault::Clipped) => FluxMark::Clipped,
        };
        let counts = mean.ok().map(|mean| mean.counts);
        let raw_scalar_pt = slot.reading.map(|reading| reading.scalar_pt);
        let epoch = Epoch {
            tick: slot.tick,
            scalar_pt: raw_scalar_pt.filter(|_| scalar == ScalarMark::Present),
            flux_nt: counts.map(|[x, y, z, _]| self.fluxgate.convert(&[x, y, z])),
        };
        let marks = EpochMarks {
            instant_us,
            scalar,
            flux,
            duplicates: slot.duplicates,
            relocked: slot.relocked,
            scalar_offset_us: slot.offset_us,
            raw_scalar_pt,
            signal: slot.reading.and_then(|reading| reading.signal),
            channels: slot.reading.map_or([None; CHANNELS], |reading| reading.channels),
            current_a: counts.map(|[_, _, _, current]| self.fluxgate.current_a(current)),
        };
        MarkedEpoch { epoch, marks }
    }
}

/// Move the grid so that an epoch lies at `instant_us`, and leave out a tick.
fn relock(state: &mut GridState, instant_us: i64, reading: &Reading) {
    let Some(phase) = &mut state.phase else { return };
    let next_tick = state.slots.drop_from(instant_us - i64::from(EPOCH_US / 2)).unwrap_or(phase.next_tick());
    phase.lock(instant_us, next_tick.wrapping_add(1));
    let mut slot = phase.open();
    slot.relocked = true;
    slot.offer(reading, 0);
    count(&mut state.counters.relocks);
    count(&mut state.counters.skipped);
    if !state.slots.push(slot) {
        count(&mut state.counters.skipped);
    }
}

impl GridCounters {
    fn count_epoch(&mut self, marks: &EpochMarks) {
        count(&mut self.epochs);
        match marks.scalar {
            ScalarMark::Missing => count(&mut self.scalar_missing),
            ScalarMark::Invalid => count(&mut self.scalar_invalid),
            ScalarMark::Present | ScalarMark::OffTime => {}
        }
        match marks.flux {
            FluxMark::Missing => count(&mut self.flux_missing),
            FluxMark::Clipped => count(&mut self.flux_clipped),
            FluxMark::Present => {}
        }
    }
}
