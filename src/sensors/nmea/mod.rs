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

pub use decode::M_PER_DBAR;
pub use parser::{LONGEST_NMEA, NmeaFaults, NmeaParser};

use super::check;
use crate::settings::SettingsError;

/// What a sensor that tells metres below itself, or its depth, is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthIs {
    /// A pressure sensor that sends its depth below the surface as if it were an echo sounder.
    Depth,
    /// An echo sounder that looks down: the metres below it are the altitude of the body.
    #[default]
    Altitude,
}

/// Settings of the third UART and of what is read from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NmeaSettings {
    /// Baud rate, 4,800 to 115,200.
    pub baud: u32,
    /// What DPT and DBT tell.
    pub depth_is: DepthIs,
    /// What the pressure sensor shows at the surface, dbar, 0 to 20: 0 where it was set to zero there, about 10.1 where it
    /// shows the air's pressure as well.
    pub surface_dbar: f64,
}

impl Default for NmeaSettings {
    /// The baud rate of the standard.
    fn default() -> Self {
        Self { baud: 4_800, depth_is: DepthIs::default(), surface_dbar: 0.0 }
    }
}

impl NmeaSettings {
    /// The parser, or which setting is wrong.
    pub fn build(&self) -> Result<NmeaParser, SettingsError> {
        check("nmea_baud", self.baud.into(), 4_800.0..=115_200.0, "4800 to 115200")?;
        check("nmea_surface_dbar", self.surface_dbar, 0.0..=20.0, "0 to 20")?;
        Ok(NmeaParser::new(*self))
    }
}
