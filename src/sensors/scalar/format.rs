//! All that is to be known of a sensor's format, and a format with the values of its own parameters.

use super::fields::{Decoded, Defect};
use super::line::Framing;
use super::scale::Scale;
use crate::settings::SettingsError;

/// Most parameters that a format can have of its own.
pub const MOST_PARAMETERS: usize = 4;

/// What a sensor sends: the one description that parser, console, settings in flash, desk and fuzzing go by.
#[derive(Debug)]
pub struct Format {
    /// What it is called on the console and on the command line.
    pub name: &'static str,
    /// What it is, in one line for a help text.
    pub title: &'static str,
    /// What it is in the settings' flash: never another's, and never changed.
    pub tag: u8,
    /// Baud rate that the sensor comes with.
    pub baud: u32,
    /// Least signal of a valid reading, in the sensor's own units, until the operator sets another.
    pub weakest_signal: u32,
    /// Greatest signal of a valid reading, in the sensor's own units, until the operator sets another.
    pub strongest_signal: u32,
    /// Its own parameters, [`MOST_PARAMETERS`] at most, in the order in which they lie in the flash.
    pub parameters: &'static [FormatParameter],
    /// How its lines begin.
    pub framing: Framing,
    /// Checks the values of the parameters, and makes of them how the field is written.
    pub check: fn(&Values) -> Result<Scale, SettingsError>,
    /// A sentence without start byte and line end.
    pub decode: fn(&Sensor, &[u8]) -> Result<Decoded, Defect>,
    /// The whole sentence that a sensor in good order sends for a field of so many picotesla; what no recording has in
    /// it is left out.
    #[cfg(not(target_os = "none"))]
    pub encode: fn(&Sensor, i32, &mut dyn core::fmt::Write) -> core::fmt::Result,
}

/// A parameter that only some formats have.
#[derive(Debug)]
pub struct FormatParameter {
    /// What it is called on the console, with its unit. Formats that share a parameter share its name.
    pub name: &'static str,
    /// Its value until the operator sets another; of the only kind that it takes.
    pub default: Value,
}

/// Value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Any number; 8 bytes in the flash.
    Number(f64),
    /// A whole number up to 255; one byte in the flash.
    Small(u8),
    /// An ASCII character; one byte in the flash.
    Mark(u8),
    /// On or off; one byte in the flash, 1 or 0.
    Switch(bool),
}

/// Values of a format's parameters, in their order. Places beyond them hold [`Value::Switch`] off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values([Value; MOST_PARAMETERS]);

impl Values {
    /// The number at a place; not a number where none is, so that no range accepts it.
    pub fn number(&self, place: usize) -> f64 {
        match self.0.get(place) {
            Some(Value::Number(number)) => *number,
            _ => f64::NAN,
        }
    }

    /// The small number or the mark at a place; 0 where none is.
    pub fn byte(&self, place: usize) -> u8 {
        match self.0.get(place) {
            Some(Value::Small(byte) | Value::Mark(byte)) => *byte,
            _ => 0,
        }
    }

    /// Whether the switch at a place is on.
    pub fn is_on(&self, place: usize) -> bool {
        self.0.get(place) == Some(&Value::Switch(true))
    }
}

/// A format with the values of its parameters.
#[derive(Clone, Copy)]
pub struct ScalarFormat {
    format: &'static Format,
    values: Values,
}

impl ScalarFormat {
    /// The format with its defaults.
    pub const fn of(format: &'static Format) -> Self {
        let mut values = [Value::Switch(false); MOST_PARAMETERS];
        let mut place = 0;
        while place < format.parameters.len() && place < MOST_PARAMETERS {
            values[place] = format.parameters[place].default;
            place += 1;
        }
        Self { format, values: Values(values) }
    }

    /// What it is a format of.
    pub fn format(&self) -> &'static Format {
        self.format
    }

    /// Value of the parameter of this name, if the format has it.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.parameters().find(|(parameter, _)| parameter.name == name).map(|(_, value)| *value)
    }

    /// The same, to be changed. A value of another kind than the default's is none that a check accepts.
    pub fn value_mut(&mut self, name: &str) -> Option<&mut Value> {
        let mut parameters = self.format.parameters.iter().zip(&mut self.values.0);
        parameters.find(|(parameter, _)| parameter.name == name).map(|(_, value)| value)
    }

    /// Its own parameters and their values, in the order of the flash.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static FormatParameter, &Value)> {
        self.format.parameters.iter().zip(&self.values.0)
    }

    /// The values of all parameters, to be changed.
    pub(crate) fn values_mut(&mut self) -> impl Iterator<Item = &mut Value> {
        self.values.0.iter_mut().take(self.format.parameters.len())
    }

    /// What decodes and encodes, or which parameter is wrong.
    pub fn build(&self) -> Result<Sensor, SettingsError> {
        Ok(Sensor { format: self.format, values: self.values, scale: (self.format.check)(&self.values)? })
    }
}

impl PartialEq for ScalarFormat {
    /// A format is its description itself, wherever another looks the same.
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.format, other.format) && self.values == other.values
    }
}

impl core::fmt::Debug for ScalarFormat {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.format.name)?;
        f.debug_map().entries(self.parameters().map(|(parameter, value)| (parameter.name, value))).finish()
    }
}

/// A format whose parameters are checked.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    format: &'static Format,
    /// The values of its parameters.
    pub values: Values,
    /// How the field is written.
    pub scale: Scale,
}

impl Sensor {
    pub(super) fn framing(&self) -> &'static Framing {
        &self.format.framing
    }

    pub(super) fn decode(&self, text: &[u8]) -> Result<Decoded, Defect> {
        (self.format.decode)(self, text)
    }

    /// The whole sentence that a sensor in good order sends for a field of so many picotesla, 0 or more. `None` if it
    /// is longer than any that can be read.
    #[cfg(not(target_os = "none"))]
    pub fn encode(&self, scalar_pt: i32) -> Option<Sentence> {
        let mut sentence = Sentence::new();
        (self.format.encode)(self, scalar_pt, &mut sentence).ok()?;
        Some(sentence)
    }
}

/// A sentence with start byte and line end.
#[cfg(not(target_os = "none"))]
pub type Sentence = heapless::String<{ super::LONGEST_SENTENCE + 3 }>;
