//! The settings by name, one value each, as an operator types and reads them.

use super::body_settings::BodySettings;
use crate::sensors::nmea::DepthIs;
use crate::sensors::scalar::{self, Format, FormatParameter, ScalarSettings, Value};
use crate::settings::{Method, SettingsError};
use core::fmt::Write;

/// One of the settings, known by its name.
#[derive(Clone, Copy)]
pub struct Parameter(Source);

/// Where a parameter comes from.
#[derive(Clone, Copy)]
enum Source {
    Body(&'static Entry),
    /// A format of the scalar sensor, or several, have it of their own.
    Format(&'static FormatParameter),
}

/// A value as text.
pub type ValueText = heapless::String<32>;

/// Length of the longest name, bytes.
pub const LONGEST_NAME: usize = 25;

/// A value of a settings struct, if the chosen format has it.
type Part<T> = fn(&mut BodySettings) -> Option<&mut T>;

struct Entry {
    name: &'static str,
    part: Kind,
}

enum Kind {
    Number(Part<f64>),
    Whole(Part<u32>),
    Small(Part<u8>),
    Order,
    Switch(Part<bool>),
    Method,
    Format,
    DepthIs,
}

/// Why a setting was not changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetError {
    /// The value is of another kind; what it may be.
    Expected(&'static str),
    /// There is no such format of the scalar sensor.
    NoFormat,
    /// The chosen format of the scalar sensor does not have this setting.
    NotInFormat,
    /// Out of its range, or it does not go with the others.
    Refused(SettingsError),
}

impl core::fmt::Display for SetError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Expected(what) => write!(f, "choose {what}"),
            Self::NoFormat => {
                f.write_str("choose ")?;
                scalar::put_names(f)
            }
            Self::NotInFormat => f.write_str("the chosen scalar_format does not have it"),
            Self::Refused(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SetError {}

const METHODS: [(&str, Method); 5] = [
    ("none", Method::None),
    ("fixed", Method::Fixed),
    ("rls", Method::Rls),
    ("saddle-point", Method::SaddlePoint),
    ("adaptive", Method::Adaptive),
];

const fn number(name: &'static str, part: Part<f64>) -> Entry {
    Entry { name, part: Kind::Number(part) }
}

const fn whole(name: &'static str, part: Part<u32>) -> Entry {
    Entry { name, part: Kind::Whole(part) }
}

/// What comes before the parameters of the formats.
static BEFORE: [Entry; 22] = [
    Entry { name: "method", part: Kind::Method },
    number("band_low_hz", |s| Some(&mut s.estimator.band_pass.low_hz)),
    number("band_high_hz", |s| Some(&mut s.estimator.band_pass.high_hz)),
    Entry { name: "band_order", part: Kind::Order },
    number("lambda1", |s| Some(&mut s.estimator.penalty.lambda1)),
    number("lambda2", |s| Some(&mut s.estimator.penalty.lambda2)),
    number("forgetting", |s| Some(&mut s.estimator.forgetting)),
    number("dual_step", |s| Some(&mut s.estimator.dual_step)),
    Entry { name: "scalar_format", part: Kind::Format },
    whole("scalar_baud", |s| Some(&mut s.scalar_baud)),
    whole("cable_baud", |s| Some(&mut s.cable_baud)),
    whole("nmea_baud", |s| Some(&mut s.nmea.baud)),
    Entry { name: "nmea_depth_is", part: Kind::DepthIs },
    number("nmea_surface_dbar", |s| Some(&mut s.nmea.surface_dbar)),
    number("scalar_lowest_nt", |s| Some(&mut s.scalar.lowest_nt)),
    number("scalar_highest_nt", |s| Some(&mut s.scalar.highest_nt)),
    whole("weakest_signal", |s| Some(&mut s.scalar.weakest_signal)),
    whole("strongest_signal", |s| Some(&mut s.scalar.strongest_signal)),
    number("g882_depth_m_per_count", |s| Some(&mut s.channels.depth_m_per_count)),
    number("g882_depth_bias_m", |s| Some(&mut s.channels.depth_bias_m)),
    number("g882_altitude_m_per_count", |s| Some(&mut s.channels.altitude_m_per_count)),
    number("g882_altitude_bias_m", |s| Some(&mut s.channels.altitude_bias_m)),
];

/// What comes after them.
static AFTER: [Entry; 27] = [
    number("flux_x_nt_per_count", |s| s.fluxgate.nt_per_count.get_mut(0)),
    number("flux_y_nt_per_count", |s| s.fluxgate.nt_per_count.get_mut(1)),
    number("flux_z_nt_per_count", |s| s.fluxgate.nt_per_count.get_mut(2)),
    number("flux_x_bias_nt", |s| s.fluxgate.bias_nt.get_mut(0)),
    number("flux_y_bias_nt", |s| s.fluxgate.bias_nt.get_mut(1)),
    number("flux_z_bias_nt", |s| s.fluxgate.bias_nt.get_mut(2)),
    number("body_x_from_x", |s| matrix(s, 0, 0)),
    number("body_x_from_y", |s| matrix(s, 0, 1)),
    number("body_x_from_z", |s| matrix(s, 0, 2)),
    number("body_y_from_x", |s| matrix(s, 1, 0)),
    number("body_y_from_y", |s| matrix(s, 1, 1)),
    number("body_y_from_z", |s| matrix(s, 1, 2)),
    number("body_z_from_x", |s| matrix(s, 2, 0)),
    number("body_z_from_y", |s| matrix(s, 2, 1)),
    number("body_z_from_z", |s| matrix(s, 2, 2)),
    number("ampere_per_count", |s| Some(&mut s.fluxgate.ampere_per_count)),
    number("current_bias_a", |s| Some(&mut s.fluxgate.current_bias_a)),
    number("battery_v_per_count", |s| Some(&mut s.housekeeping.battery_v_per_count)),
    number("battery_low_v", |s| Some(&mut s.housekeeping.battery_low_v)),
    Entry { name: "leak_fitted", part: Kind::Switch(|s| Some(&mut s.housekeeping.is_leak_fitted)) },
    whole("scalar_delay_us", |s| Some(&mut s.grid.scalar_delay_us)),
    whole("flux_delay_us", |s| Some(&mut s.grid.flux_delay_us)),
    whole("latency_us", |s| Some(&mut s.grid.latency_us)),
    whole("tolerance_us", |s| Some(&mut s.grid.tolerance_us)),
    Entry { name: "conversions_per_epoch", part: Kind::Small(|s| Some(&mut s.grid.conversions_per_epoch)) },
    Entry { name: "log", part: Kind::Switch(|s| Some(&mut s.log)) },
    whole("log_file_h", |s| Some(&mut s.log_file_h)),
];

fn matrix(settings: &mut BodySettings, body: usize, sensor: usize) -> Option<&mut f64> {
    settings.fluxgate.body_from_sensor.get_mut(body)?.get_mut(sensor)
}

impl Parameter {
    /// The parameter of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|parameter| parameter.name() == name)
    }

    /// All of them, in the order in which they are listed.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map_while(Self::at)
    }

    /// The parameter at a place of that order.
    pub fn at(place: usize) -> Option<Self> {
        let Some(mut left) = place.checked_sub(BEFORE.len()) else {
            return BEFORE.get(place).map(|entry| Self(Source::Body(entry)));
        };
        for parameter in scalar::parameters() {
            if left == 0 {
                return Some(Self(Source::Format(parameter)));
            }
            left -= 1;
        }
        AFTER.get(left).map(|entry| Self(Source::Body(entry)))
    }

    /// What it is called; its unit is in the name.
    pub fn name(self) -> &'static str {
        match self.0 {
            Source::Body(entry) => entry.name,
            Source::Format(parameter) => parameter.name,
        }
    }

    /// Its value, which [`set`](Self::set) reads back to the same bits; `None` when the chosen format does not have it.
    pub fn get(self, settings: &BodySettings) -> Option<ValueText> {
        let mut text = ValueText::new();
        match self.0 {
            Source::Body(entry) => entry.write(settings, &mut text)?,
            Source::Format(parameter) => write_value(settings.scalar.format.value(parameter.name)?, &mut text),
        }
        .ok()?;
        Some(text)
    }

    /// Change it to the value in `text`. On an error nothing is changed.
    ///
    /// A new `scalar_format` brings its own limits of the signal and its own baud rate; the range of the field stays.
    pub fn set(self, settings: &mut BodySettings, text: &str) -> Result<(), SetError> {
        let mut changed = *settings;
        self.put(&mut changed, text)?;
        changed.validate().map_err(SetError::Refused)?;
        *settings = changed;
        Ok(())
    }

    fn put(self, settings: &mut BodySettings, text: &str) -> Result<(), SetError> {
        match self.0 {
            Source::Body(entry) => entry.read(settings, text),
            Source::Format(parameter) => {
                read_value(settings.scalar.format.value_mut(parameter.name).ok_or(SetError::NotInFormat)?, text)
            }
        }
    }
}

impl Entry {
    fn write(&self, settings: &BodySettings, text: &mut ValueText) -> Option<core::fmt::Result> {
        // The parts are found in what may be changed; this one is thrown away.
        let settings = &mut settings.clone();
        Some(match self.part {
            Kind::Number(part) => write_value(Value::Number(*part(settings)?), text),
            Kind::Whole(part) => write!(text, "{}", part(settings)?),
            Kind::Small(part) => write_value(Value::Small(*part(settings)?), text),
            Kind::Order => write!(text, "{}", settings.estimator.band_pass.order),
            Kind::Switch(part) => write_value(Value::Switch(*part(settings)?), text),
            Kind::Method => text.write_str(method_name(settings.estimator.method)),
            Kind::Format => text.write_str(settings.scalar.format.format().name),
            Kind::DepthIs => text.write_str(match settings.nmea.depth_is {
                DepthIs::Depth => DEPTH,
                DepthIs::Altitude => ALTITUDE,
            }),
        })
    }

    fn read(&self, settings: &mut BodySettings, text: &str) -> Result<(), SetError> {
        match self.part {
            Kind::Number(part) => put(part(settings), number_in(text), A_NUMBER),
            Kind::Whole(part) => put(part(settings), whole_in(text), "a whole number"),
            Kind::Small(part) => put(part(settings), whole_in(text), A_SMALL),
            Kind::Order => put(Some(&mut settings.estimator.band_pass.order), whole_in(text), "1 to 8"),
            Kind::Switch(part) => put(part(settings), switch(text), ON_OR_OFF),
            Kind::Method => {
                put(Some(&mut settings.estimator.method), method(text), "none, fixed, rls, saddle-point or adaptive")
            }
            Kind::Format => set_format(settings, text),
            Kind::DepthIs => put(Some(&mut settings.nmea.depth_is), depth_is(text), "depth or altitude"),
        }
    }
}

const DEPTH: &str = "depth";
const ALTITUDE: &str = "altitude";

const A_NUMBER: &str = "a number";
const A_SMALL: &str = "a whole number up to 255";
const ON_OR_OFF: &str = "on or off";

fn write_value(value: Value, text: &mut ValueText) -> core::fmt::Result {
    match value {
        Value::Number(number) => put_number(text, number),
        Value::Small(small) => write!(text, "{small}"),
        Value::Mark(mark) => text.write_char(char::from(mark)),
        Value::Switch(on) => text.write_str(if on { "on" } else { "off" }),
    }
}

/// A value of the same kind.
fn read_value(value: &mut Value, text: &str) -> Result<(), SetError> {
    match value {
        Value::Number(number) => put(Some(number), number_in(text), A_NUMBER),
        Value::Small(small) => put(Some(small), whole_in(text), A_SMALL),
        Value::Mark(mark) => put(Some(mark), single(text), "one character"),
        Value::Switch(on) => put(Some(on), switch(text), ON_OR_OFF),
    }
}

impl core::fmt::Debug for Parameter {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Parameter {}

fn put<T>(place: Option<&mut T>, value: Option<T>, expected: &'static str) -> Result<(), SetError> {
    *place.ok_or(SetError::NotInFormat)? = value.ok_or(SetError::Expected(expected))?;
    Ok(())
}

/// The shortest digits that give the same bits back, with an exponent where that would be a row of zeros.
fn put_number(text: &mut ValueText, value: f64) -> core::fmt::Result {
    let magnitude = libm::fabs(value);
    if magnitude == 0.0 || (1e-3..1e9).contains(&magnitude) {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    }
}

fn number_in(text: &str) -> Option<f64> {
    lexical_core::parse(text.as_bytes()).ok()
}

/// A whole number of any width: parsed at one width alone, as each takes room in the flash.
fn whole_in<T: TryFrom<u32>>(text: &str) -> Option<T> {
    text.parse::<u32>().ok()?.try_into().ok()
}

fn switch(text: &str) -> Option<bool> {
    match text {
        "on" | "1" => Some(true),
        "off" | "0" => Some(false),
        _ => None,
    }
}

fn single(text: &str) -> Option<u8> {
    match text.as_bytes() {
        [byte] => Some(*byte),
        _ => None,
    }
}

fn depth_is(text: &str) -> Option<DepthIs> {
    match text {
        DEPTH => Some(DepthIs::Depth),
        ALTITUDE => Some(DepthIs::Altitude),
        _ => None,
    }
}

fn method(text: &str) -> Option<Method> {
    METHODS.iter().find(|(name, _)| *name == text).map(|(_, method)| *method)
}

fn method_name(method: Method) -> &'static str {
    METHODS.iter().find(|(_, other)| *other == method).map_or("", |(name, _)| name)
}

fn set_format(settings: &mut BodySettings, name: &str) -> Result<(), SetError> {
    let format = Format::named(name).ok_or(SetError::NoFormat)?;
    let ScalarSettings { lowest_nt, highest_nt, .. } = settings.scalar;
    settings.scalar = ScalarSettings { lowest_nt, highest_nt, ..ScalarSettings::of(format) };
    settings.scalar_baud = format.baud;
    Ok(())
}
