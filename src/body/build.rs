//! What the body runs: its firmware, and what its settings build.

use crate::pipeline::Pipeline;
use crate::sensors::grid::Grid;
use crate::sensors::nmea::NmeaParser;
use crate::sensors::scalar::ScalarParser;
use crate::settings::Settings;
use crate::store::{BodySettings, Stored};
use core::mem::MaybeUninit;

/// What the firmware was built from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Firmware {
    /// Version of the package.
    pub version: &'static str,
    /// Commit of the source: forty hexadecimal digits, and a `+` when the source was changed since.
    pub commit: &'static str,
}

impl Firmware {
    /// The commit as the log's header has it, filled up with zeros; what are no digits is zero.
    pub fn build_hash(&self) -> [u8; 32] {
        let mut hash = [0; 32];
        for (place, digits) in hash.iter_mut().zip(self.commit.as_bytes().chunks(2)) {
            let digits = core::str::from_utf8(digits).ok();
            *place = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()).unwrap_or(0);
        }
        hash
    }
}

/// What the settings build besides the pipeline.
pub struct Built {
    /// Puts both sensors on the 10 Hz grid.
    pub grid: Grid,
    /// Reads the scalar sensor's sentences.
    pub parser: ScalarParser,
    /// Reads the sentences of the third UART.
    pub nmea: NmeaParser,
}

/// Build grid and parsers. Settings that were stored have been checked; should some not build, the body must nonetheless run.
pub fn build(settings: &BodySettings) -> Built {
    let built = |settings: &BodySettings| {
        let grid = settings.grid.build(settings.fluxgate.build().ok()?).ok()?;
        Some(Built { grid, parser: settings.scalar.build().ok()?, nmea: settings.nmea.build().ok()? })
    };
    built(settings).or_else(|| built(&BodySettings::default())).expect("the default settings are valid")
}

/// Build the pipeline where it stays.
pub fn build_pipeline(place: &'static mut MaybeUninit<Option<Pipeline>>, stored: &Stored) -> &'static mut Pipeline {
    let place = place.write(None);
    if Pipeline::start_in(place, &stored.settings.estimator, &stored.prior()).is_err() {
        _ = Pipeline::start_in(place, &Settings::default(), &stored.prior());
    }
    place.as_mut().expect("the default settings are valid")
}

#[cfg(test)]
mod tests {
    use super::Firmware;

    #[test]
    fn the_hash_is_that_of_the_commit() {
        let firmware = Firmware { version: "1", commit: "0123456789abcdef0123456789abcdef01234567+" };
        let mut hash = [0; 32];
        hash[..20].copy_from_slice(&[
            0x01, 0x23, 0x45, 0x67, 0x89, 0xab, 0xcd, 0xef, 0x01, 0x23, 0x45, 0x67, 0x89, 0xab, 0xcd, 0xef, 0x01, 0x23,
            0x45, 0x67,
        ]);
        assert_eq!(firmware.build_hash(), hash);
    }
}
