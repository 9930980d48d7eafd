//! All that an operator can set, in one place.

use crate::RATE_HZ;
use crate::estimate::{Information, Prior};
use crate::housekeeping::HousekeepingSettings;
use crate::model::Coefficients;
use crate::sensors::check;
use crate::sensors::fluxgate::FluxgateSettings;
use crate::sensors::grid::GridSettings;
use crate::sensors::nmea::NmeaSettings;
use crate::sensors::scalar::{ChannelSettings, ScalarSettings};
use crate::settings::{Settings, SettingsError};
use core::ops::RangeInclusive;

/// What the scalar sensor's UART may be set to: all of it can be made within 2 % on each of the body's clocks, see
/// [`divided_baud`](crate::microcontroller::divided_baud). The divisor of 1,200 baud would not fit its register.
pub const SCALAR_BAUD: RangeInclusive<u32> = 2_400..=115_200;

/// The same for the tow cable's UART.
pub const CABLE_BAUDS: RangeInclusive<u32> = 9_600..=921_600;

/// Hours of log that a file may have room for.
pub const LOG_FILE_HOURS: RangeInclusive<u32> = 1..=240;

/// Baud rate of a new body's tow cable, which `host-sim listen` tries first. For a cable of some ten metres, or more with
/// RS-422; set a slower one for RS-232 over a long cable.
pub const CABLE_BAUD: u32 = 115_200;

/// All that an operator can set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySettings {
    /// The estimator and its band-pass; the sample rate is [`RATE_HZ`].
    pub estimator: Settings,
    /// The scalar sensor.
    pub scalar: ScalarSettings,
    /// Depth and altitude that a G-882 sends with its field.
    pub channels: ChannelSettings,
    /// Baud rate of the scalar sensor's UART, within [`SCALAR_BAUD`].
    pub scalar_baud: u32,
    /// Baud rate of the tow cable, both ways, within [`CABLE_BAUDS`].
    pub cable_baud: u32,
    /// The third UART: depth, altitude, position and heading.
    pub nmea: NmeaSettings,
    /// Leak contact and battery voltage.
    pub housekeeping: HousekeepingSettings,
    /// The fluxgate and the current channel.
    pub fluxgate: FluxgateSettings,
    /// Timing of both sensors.
    pub grid: GridSettings,
    /// Whether epochs go to the card, also after the next start.
    pub log: bool,
    /// Size of a new log file, hours of 10 Hz epochs, 1 to 240. A file that is on the card keeps its own.
    pub log_file_h: u32,
}

impl Default for BodySettings {
    /// A G-882 at 9600 baud, the adaptive estimator, and a log of three days.
    fn default() -> Self {
        Self {
            estimator: Settings::default(),
            scalar: ScalarSettings::G882,
            channels: ChannelSettings::default(),
            scalar_baud: 9600,
            cable_baud: CABLE_BAUD,
            nmea: NmeaSettings::default(),
            housekeeping: HousekeepingSettings::default(),
            fluxgate: FluxgateSettings::default(),
            grid: GridSettings::default(),
            log: true,
            log_file_h: 72,
        }
    }
}

impl BodySettings {
    /// Check every number against its range: everything can be built from settings that pass.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.estimator.validate()?;
        self.estimator.band_pass.build()?;
        let sample_rate_hz = self.estimator.band_pass.sample_rate_hz;
        check("sample_rate_hz", sample_rate_hz, RATE_HZ..=RATE_HZ, "10")?;
        self.scalar.build()?;
        self.channels.validate()?;
        self.nmea.build()?;
        self.housekeeping.validate()?;
        let scalar_baud = f64::from(*SCALAR_BAUD.start())..=f64::from(*SCALAR_BAUD.end());
        let cable_baud = f64::from(*CABLE_BAUDS.start())..=f64::from(*CABLE_BAUDS.end());
        check("cable_baud", self.cable_baud.into(), cable_baud, "9600 to 921600")?;
        check("scalar_baud", self.scalar_baud.into(), scalar_baud, "2400 to 115200")?;
        self.grid.build(self.fluxgate.build()?)?;
        let hours = f64::from(*LOG_FILE_HOURS.start())..=f64::from(*LOG_FILE_HOURS.end());
        check("log_file_h", self.log_file_h.into(), hours, "1 to 240")?;
        Ok(())
    }
}

/// What lies in the flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// What the operator has set.
    pub settings: BodySettings,
    /// The coefficients of the accepted calibration, zero before the first.
    pub coefficients: Coefficients,
    /// The information behind them, which the adaptive method starts from.
    pub information: Option<Information>,
    /// What the calibration has learnt of the level.
    pub level: Option<Information>,
}

impl Stored {
    /// What a [`Pipeline`](crate::Pipeline) starts from.
    pub fn prior(&self) -> Prior {
        Prior { coefficients: self.coefficients, information: self.information, level: self.level }
    }

    /// Take over an accepted calibration.
    pub fn accept(&mut self, prior: &Prior) {
        self.coefficients = prior.coefficients;
        self.information = prior.information;
        self.level = prior.level;
    }

    /// Take over an accepted calibration of the fluxgate. The coefficients go: they were found in its old axes, and what
    /// they are known by is no longer true.
    pub fn accept_fluxgate(&mut self, fluxgate: &FluxgateSettings) {
        self.settings.fluxgate.take_axes(fluxgate);
        self.accept(&Prior { coefficients: Coefficients::ZERO, information: None, level: None });
    }
}

impl Default for Stored {
    /// Default settings, no coefficients.
    fn default() -> Self {
        Self { settings: BodySettings::default(), coefficients: Coefficients::ZERO, information: None, level: None }
    }
}
