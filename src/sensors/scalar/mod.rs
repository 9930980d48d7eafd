//! Scalar sensors: bytes in, readings out.
//!
//! All formats are lines of ASCII text without a checksum, so that a byte lost in the middle of a number can leave
//! a plausible wrong one. Three things stand against it: the receiver's own errors discard the sentence they fall
//! into ([`ScalarParser::receive_error`]), every sentence must have its format's exact form, and the accepted range of
//! the field can be narrowed to what the survey area holds ([`ScalarSettings::lowest_nt`]).
//!
//! A new sensor is a file here, which exports its [`Format`], and its place in [`FORMATS`]: console, settings in flash,
//! command line, emulation and fuzzing go by that list.

mod channels;
mod faults;
mod fields;
mod format;
pub mod g882;
mod line;
mod parser;
pub mod qtfm_gen1;
pub mod qtfm_gen2;
mod reader;
mod scale;
pub mod seaspy;

pub use channels::ChannelSettings;
pub use faults::{LONGEST_SENTENCE, ScalarFaults};
pub use fields::CHANNELS;
pub use fields::{Decoded, Defect, Fields, Marker};
#[cfg(not(target_os = "none"))]
pub use format::Sentence;
pub use format::{Format, FormatParameter, MOST_PARAMETERS, ScalarFormat, Sensor, Value, Values};
pub use line::Framing;
pub use parser::{Reading, ScalarParser};
pub use reader::ScalarReader;
pub use scale::{CountScale, Scale};

use super::check;
use crate::settings::SettingsError;

/// Every format that an operator can choose, in the order in which they are listed.
pub static FORMATS: [&Format; 5] =
    [&g882::FORMAT, &qtfm_gen1::FORMAT, &qtfm_gen2::FORMAT, &qtfm_gen2::COUNTS, &seaspy::FORMAT];

const _: () = {
    let mut place = 0;
    while place < FORMATS.len() {
        assert!(
            FORMATS[place].parameters.len() <= MOST_PARAMETERS,
            "a format has more parameters than its values have room"
        );
        place += 1;
    }
};

/// The parameters that formats have of their own, each name once, in the order of [`FORMATS`].
pub fn parameters() -> impl Iterator<Item = &'static FormatParameter> {
    FORMATS.iter().enumerate().flat_map(|(place, format)| {
        let is_new = move |parameter: &&FormatParameter| {
            let mut earlier = FORMATS.iter().take(place).flat_map(|format| format.parameters);
            earlier.all(|other| other.name != parameter.name)
        };
        format.parameters.iter().filter(is_new)
    })
}

/// The names of [`FORMATS`] as text: `a, b or c`.
pub(crate) fn put_names(f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
    for (place, format) in FORMATS.iter().enumerate() {
        let before = match place {
            0 => "",
            _ if place + 1 == FORMATS.len() => " or ",
            _ => ", ",
        };
        f.write_str(before)?;
        f.write_str(format.name)?;
    }
    Ok(())
}

impl Format {
    /// The format that an operator calls by this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        FORMATS.into_iter().find(|format| format.name == name)
    }
}

/// Settings of the scalar sensor. `build` turns them into a parser, once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarSettings {
    /// What the sensor sends.
    pub format: ScalarFormat,
    /// Least total field of a valid reading, nT; 1,000 to 100,000 and not above `highest_nt`.
    pub lowest_nt: f64,
    /// Greatest total field of a valid reading, nT; 1,000 to 100,000.
    pub highest_nt: f64,
    /// Least signal of a valid reading, in the sensor's own units. A reading that carries no signal passes.
    pub weakest_signal: u32,
    /// Greatest signal of a valid reading, in the sensor's own units.
    pub strongest_signal: u32,
}

impl ScalarSettings {
    /// What a new body expects.
    pub const G882: Self = Self::of(&g882::FORMAT);

    /// A sensor of this format, with the format's own defaults and any field from 1,000 to 100,000 nT.
    pub const fn of(format: &'static Format) -> Self {
        Self {
            format: ScalarFormat::of(format),
            lowest_nt: 1_000.0,
            highest_nt: 100_000.0,
            weakest_signal: format.weakest_signal,
            strongest_signal: format.strongest_signal,
        }
    }

    /// The parser, or which setting is wrong.
    pub fn build(&self) -> Result<ScalarParser, SettingsError> {
        check("lowest_nt", self.lowest_nt, 1_000.0..=self.highest_nt, "1000 to highest_nt")?;
        check("highest_nt", self.highest_nt, 1_000.0..=100_000.0, "1000 to 100000")?;
        check("weakest_signal", self.weakest_signal.into(), 0.0..=self.strongest_signal.into(), "0 to strongest")?;
        let field_range_pt = (libm::round(self.lowest_nt * 1e3) as i32)..=(libm::round(self.highest_nt * 1e3) as i32);
        Ok(ScalarParser::new(self.format.build()?, field_range_pt, self.weakest_signal..=self.strongest_signal))
    }
}
