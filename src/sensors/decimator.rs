//! From the converter's 250 conversions per second to one mean per epoch, centred where the epoch is.
//!
//! The window is a symmetric box one epoch long. Its ends fall between two conversions, and those two are weighted by the
//! part of them that lies inside: a conversion is itself a mean over its period, so that this is the mean over the
//! window, not a guess between two points. A box that could only move by whole conversions would wander by +-2 ms
//! against the scalar sensor's clock, and jump by 4 ms every 40 s at 100 ppm; at 1,000 nT of interference and 0.3 rad/s of
//! roll a jump of 4 ms is 1 nT.

use super::check;
use crate::settings::SettingsError;

/// Conversions kept: 0.76 s at 250 SPS, more than an epoch ever waits for its scalar reading.
pub const DEPTH: usize = 192;

/// Length of an epoch, microseconds.
const EPOCH_US: i32 = crate::EPOCH_US as i32;

/// Channels of a conversion: three axes and the current.
const CHANNELS: usize = 4;

/// The end conversions are weighted in steps of this fraction: 16 us at 250 SPS.
const WEIGHT_ONE: i64 = 256;

/// Rails of the 24-bit converter.
const LOWEST_COUNT: i32 = -8_388_608;
const HIGHEST_COUNT: i32 = 8_388_607;

/// Mean over one window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// Mean count of each channel. An exact integer sum, split so that the mean of equal counts is that count.
    pub counts: [f32; CHANNELS],
    /// How far the conversion nearest to the centre lies behind it, microseconds: taken into account by the weights,
    /// except with fewer than five conversions to an epoch.
    pub phase_us: i32,
}

/// Why there is no mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowFault {
    /// Conversions are missing, doubled or off their time.
    Incomplete,
    /// An axis reached the converter's full scale.
    Clipped,
}

/// Averages conversions: immutable configuration.
#[derive(Clone, Copy, Debug)]
pub struct Decimator {
    conversions_per_epoch: usize,
    period_us: i32,
}

/// The latest conversions.
#[derive(Clone, Debug)]
pub struct DecimatorState {
    conversions: [Conversion; DEPTH],
    next: usize,
    held: usize,
}

#[derive(Clone, Copy, Debug)]
struct Conversion {
    stamp_us: u32,
    counts: [i32; CHANNELS],
}

impl DecimatorState {
    /// No conversions yet.
    pub const fn new() -> Self {
        let none = Conversion { stamp_us: 0, counts: [0; CHANNELS] };
        Self { conversions: [none; DEPTH], next: 0, held: 0 }
    }

    /// One conversion of the three axes and the current, stamped when it became ready.
    pub fn push(&mut self, counts: [i32; CHANNELS], stamp_us: u32) {
        if let Some(place) = self.conversions.get_mut(self.next) {
            *place = Conversion { stamp_us, counts };
        }
        self.next = (self.next + 1) % DEPTH;
        self.held = (self.held + 1).min(DEPTH);
    }

    /// The conversion that came `back` conversions before the latest one.
    fn back(&self, back: usize) -> Option<&Conversion> {
        if back >= self.held {
            return None;
        }
        self.conversions.get((self.next + DEPTH - 1 - back) % DEPTH)
    }

    /// How far back the conversion nearest to `center_us` is.
    fn nearest(&self, center_us: u32) -> Option<(usize, i32)> {
        let phases = (0..self.held).filter_map(|back| Some((back, since(self.back(back)?.stamp_us, center_us))));
        phases.min_by_key(|(_, phase_us)| phase_us.unsigned_abs())
    }
}

impl Default for DecimatorState {
    fn default() -> Self {
        Self::new()
    }
}

/// Time from `earlier_us` to `later_us`, microseconds, right while they lie less than 35 minutes apart.
fn since(later_us: u32, earlier_us: u32) -> i32 {
    later_us.wrapping_sub(earlier_us) as i32
}

impl Decimator {
    /// Decimator for an odd number of conversions to an epoch, 1 to 25. The converter's slowest rate makes 25; fewer are for
    /// a bench that sends fewer. Below five the nearest conversions are taken as they are.
    pub fn new(conversions_per_epoch: u8) -> Result<Self, SettingsError> {
        let (name, value, allowed) =
            ("conversions_per_epoch", f64::from(conversions_per_epoch), "an odd number, 1 to 25");
        check(name, value, 1.0..=25.0, allowed)?;
        if conversions_per_epoch.is_multiple_of(2) {
            return Err(SettingsError::OutOfRange { name, value, allowed });
        }
        let period_us = EPOCH_US / i32::from(conversions_per_epoch);
        Ok(Self { conversions_per_epoch: conversions_per_epoch.into(), period_us })
    }

    /// Time from the centre of a window until its last conversion has been pushed at the latest, microseconds. The mean
    /// itself belongs to the centre: the window is symmetric.
    pub fn group_delay_us(&self) -> u32 {
        (EPOCH_US / 2 + self.period_us).unsigned_abs()
    }

    /// Mean of the conversions that became ready within half an epoch of `center_us`.
    pub fn mean_at(&self, state: &DecimatorState, center_us: u32) -> Result<Mean, WindowFault> {
        let (middle, phase_us) = state.nearest(center_us).ok_or(WindowFault::Incomplete)?;
        let half = self.conversions_per_epoch / 2;
        let newest = middle.checked_sub(half).ok_or(WindowFault::Incomplete)?;
        let mut window = Window { backs: (newest, middle + half), weight: 0, entering: newest, leaving: newest };
        if self.conversions_per_epoch >= 5 && phase_us != 0 {
            window.shift(phase_us, self.period_us).ok_or(WindowFault::Incomplete)?;
        }
        // Up to an eighth of a period is jitter of the stamps.
        if phase_us.abs() > self.period_us / 2 + self.period_us / 8 || !self.regular(state, &window) {
            return Err(WindowFault::Incomplete);
        }
        window.mean(state, self.conversions_per_epoch, phase_us)
    }

    /// Whether every conversion of the window follows the one before it after about one period.
    fn regular(&self, state: &DecimatorState, window: &Window) -> bool {
        let (newest, oldest) = (window.backs.0.min(window.entering), window.backs.1.max(window.entering));
        (newest..oldest).all(|back| match (state.back(back), state.back(back + 1)) {
            (Some(later), Some(earlier)) => {
                let step_us = since(later.stamp_us, earlier.stamp_us);
                (self.period_us / 2..self.period_us + self.period_us / 2).contains(&step_us)
            }
            _ => false,
        })
    }
}

/// Whole conversions from `backs.0` to `backs.1` back, of which `leaving` gives `weight` of its own to `entering`, the
/// neighbour beyond the other end.
struct Window {
    backs: (usize, usize),
    weight: i64,
    entering: usize,
    leaving: usize,
}

impl Window {
    /// Move the window by `phase_us` against its conversions; `None` when the neighbour has not come yet.
    fn shift(&mut self, phase_us: i32, period_us: i32) -> Option<()> {
        let (newest, oldest) = self.backs;
        (self.leaving, self.entering) =
            if phase_us > 0 { (newest, oldest + 1) } else { (oldest, newest.checked_sub(1)?) };
        let (phase_us, period_us) = (i64::from(phase_us.unsigned_abs()), i64::from(period_us));
        // A period is never zero; a division that need not be told so cannot panic.
        self.weight = (phase_us * WEIGHT_ONE + period_us / 2).checked_div(period_us)?;
        Some(())
    }

    fn mean(&self, state: &DecimatorState, conversions: usize, phase_us: i32) -> Result<Mean, WindowFault> {
        let mut sums = [0_i64; CHANNELS];
        let (newest, oldest) = self.backs;
        let whole = (newest..=oldest).map(|back| (back, WEIGHT_ONE));
        for (back, weight) in whole.chain([(self.entering, self.weight), (self.leaving, -self.weight)]) {
            let conversion = state.back(back).ok_or(WindowFault::Incomplete)?;
            let [x, y, z, _] = conversion.counts;
            if [x, y, z].iter().any(|count| *count <= LOWEST_COUNT || *count >= HIGHEST_COUNT) {
                return Err(WindowFault::Clipped);
            }
            for (sum, count) in sums.iter_mut().zip(conversion.counts) {
                *sum += weight * i64::from(count);
            }
        }
        let total = conversions as i64 * WEIGHT_ONE;
        let mean = |sum: i64| {
            // There is at least one conversion.
            let whole = sum.checked_div_euclid(total).unwrap_or(0);
            whole as f32 + (sum - whole * total) as f32 / total as f32
        };
        Ok(Mean { counts: sums.map(mean), phase_us })
    }
}
