//! What the tasks of the firmware do with data, without the tasks: the same code runs in `host-sim emulate`, which holds
//! the emulated body against it.

use crate::logbook::EpochRecord;
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
