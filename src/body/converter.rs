//! The fluxgate's converter, kept set up.

use crate::sensors::ads131m04::{AdcError, AdcFaults, AdcSettings, Ads131m04};
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
    /// Of the latest set-up; `None` before the first.
    set_up: Option<Result<u16, AdcError>>,
    is_set_up: bool,
    tried_us: Option<u32>,
}

impl<Spi: SpiDevice> Converter<Spi> {
    /// A converter that nothing has been sent to.
    pub fn new(spi: Spi) -> Self {
        Self { adc: Ads131m04::new(spi, AdcSettings::default()), set_up: None, is_set_up: false, tried_us: None }
    }

    /// Set it up if it is not; at most once a second, as a failing attempt takes a millisecond.
    pub fn set_up(&mut self, now_us: u32, delay: &mut impl DelayNs) -> bool {
        let due = self.tried_us.is_none_or(|tried_us| now_us.wrapping_sub(tried_us) >= SET_UP_AGAIN_US);
        if !self.is_set_up && due {
            self.tried_us = Some(now_us);
            let set_up = self.adc.init(delay);
            (self.set_up, self.is_set_up) = (Some(set_up), set_up.is_ok());
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

    /// What came of the latest attempt to set it up: its ID register.
    pub fn latest_set_up(&self) -> Option<Result<u16, AdcError>> {
        self.set_up
    }

    /// Its ID register as it is now, if it is set up.
    pub fn identity(&mut self) -> Option<Result<u16, AdcError>> {
        if self.is_set_up { Some(self.adc.identity()) } else { self.set_up }
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
