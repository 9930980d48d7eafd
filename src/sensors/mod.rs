//! From what the sensors send to [`Epoch`](crate::Epoch)s.
//!
//! ```text
//! UART bytes  -> ScalarParser -> Reading ----------------------+
//!                (one of scalar::FORMATS)                      |
//!                                                              v
//! SPI frames  -> Ads131m04    -> 4 x i32 counts, 250 SPS -> Grid -> Epoch and EpochMarks, 10 Hz
//!                                                          (Decimator, Fluxgate)
//!
//! UART bytes  -> NmeaParser   -> NavigationReport: past the core, to log and cable
//! ```
//!
//! Every input carries the stamp of one free-running microsecond timer (`u32`, wraps every 71.6 minutes), taken by the
//! caller. Nothing here knows a clock, a pin or a chip. What is wrong with the data is counted, never guessed at.

pub mod ads131m04;
pub mod decimator;
pub mod fluxgate;
pub mod grid;
pub mod nmea;

pub mod scalar;

use crate::settings::SettingsError;

/// Refuse a number outside its range, by name. A NaN lies outside every range.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    range: core::ops::RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), SettingsError> {
    if range.contains(&value) { Ok(()) } else { Err(SettingsError::OutOfRange { name, value, allowed }) }
}

/// Count one more; a full counter stays full.
fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}
