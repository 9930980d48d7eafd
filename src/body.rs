//! What the tasks of the firmware do with data, without the tasks: the same code runs in `host-sim emulate`, which holds
//! the emulated body against it.

use crate::log::EpochRecord;
use crate::sensors::ads131m04::{AdcError, AdcFaults, AdcSettings, Ads131m04};
use crate::sensors::grid::{EpochMarks, FluxMark, ScalarMark};
use crate::{Epoch, Output};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;

/// Between two attempts to set up a converter that does not answer, microseconds.
const SET_UP_AGAIN_US: u32 = 1_000_000;

/// One conversion of the three axes and the current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conversion {
    /// Counts of the four channels.
    pub counts: [i32; 4],
    /// Timer when it became ready, microseconds.
    pub ready_us: u32,
}

/// The fluxgate's converter, set up again whenever it has lost its registers.
pub struct Converter<Spi> {
    adc: Ads131m04<Spi>,
    is_set_up: bool,
    tried_us: Option<u32>,
}

impl<Spi: SpiDevice> Converter<Spi> {
    /// A converter that nothing has been sent to.
    pub fn new(spi: Spi) -> Self {
        Self { adc: Ads131m04::new(spi, AdcSettings::default()), is_set_up: false, tried_us: None }
    }

    /// Set it up if it is not; at most once a second, as a failing attempt takes a millisecond.
    pub fn set_up(&mut self, now_us: u32, delay: &mut impl DelayNs) -> bool {
        let due = self.tried_us.is_none_or(|tried_us| now_us.wrapping_sub(tried_us) >= SET_UP_AGAIN_US);
        if !self.is_set_up && due {
            self.tried_us = Some(now_us);
            self.is_set_up = self.adc.init(delay).is_ok();
        }
        self.is_set_up
    }

    /// A conversion is ready since `ready_us`: fetch it. `None` when it is lost, which the faults tell of.
    pub fn fetch(&mut self, ready_us: u32, delay: &mut impl DelayNs) -> Option<Conversion> {
        if !self.is_set_up {
            self.set_up(ready_us, delay);
            return None;
        }
        match self.adc.read() {
            Ok(counts) => Some(Conversion { counts, ready_us }),
            Err(error) => {
                self.is_set_up = !matches!(error, AdcError::Reset(_) | AdcError::Corrupted(_));
                None
            }
        }
    }

    /// The SPI device.
    pub fn bus_mut(&mut self) -> &mut Spi {
        self.adc.bus_mut()
    }

    /// Errors since the start.
    pub fn faults(&self) -> &AdcFaults {
        self.adc.faults()
    }
}

/// Flags of [`EpochRecord::faults`].
pub mod fault {
    /// No scalar reading came.
    pub const SCALAR_MISSING: u32 = 1 << 0;
    /// The scalar reading is invalid.
    pub const SCALAR_INVALID: u32 = 1 << 1;
    /// The scalar reading came off its time.
    pub const SCALAR_OFF_TIME: u32 = 1 << 2;
    /// More than one scalar reading came.
    pub const SCALAR_DOUBLED: u32 = 1 << 3;
    /// The grid was moved to the scalar sensor's phase.
    pub const RELOCKED: u32 = 1 << 4;
    /// Fluxgate conversions are missing.
    pub const FLUX_MISSING: u32 = 1 << 5;
    /// The fluxgate's converter is at its full scale.
    pub const FLUX_CLIPPED: u32 = 1 << 6;
}

/// The fault flags of an epoch.
pub fn faults_of(marks: &EpochMarks) -> u32 {
    let scalar = match marks.scalar {
        ScalarMark::Present => 0,
        ScalarMark::Missing => fault::SCALAR_MISSING,
        ScalarMark::Invalid => fault::SCALAR_INVALID,
        ScalarMark::OffTime => fault::SCALAR_OFF_TIME,
    };
    let flux = match marks.flux {
        FluxMark::Present => 0,
        FluxMark::Missing => fault::FLUX_MISSING,
        FluxMark::Clipped => fault::FLUX_CLIPPED,
    };
    let flag = |is_set: bool, flag| if is_set { flag } else { 0 };
    scalar | flux | flag(marks.duplicates > 0, fault::SCALAR_DOUBLED) | flag(marks.relocked, fault::RELOCKED)
}

/// Makes the log's record of an epoch; keeps the fault flags, which are recorded when they change.
#[derive(Clone, Copy, Debug, Default)]
pub struct Recorder {
    faults: u32,
}

impl Recorder {
    /// The record of an epoch and what the core answered.
    pub fn record(&mut self, epoch: Epoch, marks: &EpochMarks, output: Output) -> EpochRecord {
        let faults = faults_of(marks);
        let changed = core::mem::replace(&mut self.faults, faults) != faults;
        EpochRecord { epoch, output, battery_a: marks.current_a, faults: changed.then_some(faults) }
    }
}

/// Time of day, told by the free-running timer from when it was set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    unix_us: u64,
    stamp_us: u32,
}

impl Clock {
    /// It is `unix_ms` milliseconds since 1970-01-01 UTC when the timer shows `stamp_us`.
    pub fn set(unix_ms: u64, stamp_us: u32) -> Self {
        Self { unix_us: unix_ms.saturating_mul(1_000), stamp_us }
    }

    /// The time at a stamp, milliseconds since 1970-01-01 UTC. The timer wraps: the stamp may be half an hour from that
    /// of the latest call, which the firmware makes at every epoch.
    pub fn unix_ms(&mut self, stamp_us: u32) -> u64 {
        let ahead_us = stamp_us.wrapping_sub(self.stamp_us) as i32;
        self.unix_us = self.unix_us.saturating_add_signed(ahead_us.into());
        self.stamp_us = stamp_us;
        self.unix_us / 1_000
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;

    #[test]
    fn the_clock_outlives_the_wrap_of_its_timer() {
        let mut clock = Clock::set(1_800_000_000_000, u32::MAX - 99_999);
        // The epoch under way when it was set began before.
        assert_eq!(clock.unix_ms(u32::MAX - 149_999), 1_799_999_999_950);
        for epoch in 0..100_000_u32 {
            let stamp_us = (u32::MAX - 49_999).wrapping_add(epoch.wrapping_mul(100_000));
            assert_eq!(clock.unix_ms(stamp_us), 1_800_000_000_050 + u64::from(epoch) * 100);
        }
    }
}
