//! NMEA 0183: depth, altitude, position and heading, from any talker.
//!
//! | sentence | what is taken of it |
//! |---|---|
//! | `--DPT`, `--DBT` | metres below the transducer: the altitude of an echo sounder, or the depth, by [`DepthIs`] |
//! | `--GGA` | position and quality of the fix; none without a fix |
//! | `--HDT`, `--HDG`, `--HDM` | heading; it is true when the sentence says so or brings the variation |
//! | `$PRVAT` | altitude and pressure: Valeport VA500, manual 0430831e, p. 4 |
//! | `$PIPS`, `$PVIPS2` | pressure or depth: Valeport miniIPS2, manual of 2020, p. 20 and 21 |
//!
//! All others are passed over. A sentence without the right checksum is refused and counted. The parser is the project's
//! own: the crate `nmea` brings `nom`, `chrono` and a second way to read numbers, and none of the towed bodies' sentences.

mod decode;
mod parser;
mod settings;

pub use decode::M_PER_DBAR;
pub use parser::{LONGEST_NMEA, NmeaFaults, NmeaParser};
pub use settings::{DepthIs, NmeaSettings};

use super::check;
use crate::settings::SettingsError;

impl NmeaSettings {
    /// The parser, or which setting is wrong.
    pub fn build(&self) -> Result<NmeaParser, SettingsError> {
        check("nmea_baud", self.baud.into(), 4_800.0..=115_200.0, "4800 to 115200")?;
        check("nmea_surface_dbar", self.surface_dbar, 0.0..=20.0, "0 to 20")?;
        Ok(NmeaParser::new(*self))
    }
}
