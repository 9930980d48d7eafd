//! A sentence whose checksum was right, to values.

use super::settings::{DepthIs, NmeaSettings};
use crate::navigation::{Heading, Navigation, Position};

/// A sentence that is not of its own form.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Malformed;

type Decoded = Result<Navigation, Malformed>;

/// Metres of sea water to a decibar: 10,000 Pa / (1,025 kg/m3 x 9.80665 m/s2). At 100 m this is within 0.5 m of what the
/// water's own density and the latitude make of it; fresh water is 2.5 % deeper.
pub const M_PER_DBAR: f64 = 0.994_84;

/// No depth, altitude or pressure is beyond, m or dbar.
const LONGEST_M: f64 = 12_000.0;

/// What a sentence tells, from its address to before the `*`. Sentences that are not read tell nothing.
pub(super) fn decode(settings: &NmeaSettings, sentence: &[u8]) -> Decoded {
    let mut fields = Fields(sentence);
    match fields.text() {
        b"PRVAT" => range_and_pressure(settings, fields),
        b"PIPS" => pressure_or_depth(settings, fields),
        b"PVIPS2" => depth_behind_pressure(fields),
        [b'P', ..] => Ok(Navigation::default()),
        [_, _, b'D', b'P', b'T'] => below_transducer(settings, fields),
        [_, _, b'D', b'B', b'T'] => {
            fields.skip(2); // feet
            below_transducer(settings, fields)
        }
        [_, _, b'G', b'G', b'A'] => position(fields),
        [_, _, b'H', b'D', b'T'] => heading(fields, b"T", false),
        [_, _, b'H', b'D', b'M'] => heading(fields, b"M", true),
        [_, _, b'H', b'D', b'G'] => heading_with_variation(fields),
        _ => Ok(Navigation::default()),
    }
}

fn below_transducer(settings: &NmeaSettings, mut fields: Fields<'_>) -> Decoded {
    let below_m = fields.metres()?;
    Ok(match settings.depth_is {
        DepthIs::Depth => Navigation { depth_m: below_m, ..Navigation::default() },
        DepthIs::Altitude => Navigation { altitude_m: below_m, ..Navigation::default() },
    })
}

/// `range,M,pressure,dBar`; without the optional sensor the last two are missing.
fn range_and_pressure(settings: &NmeaSettings, mut fields: Fields<'_>) -> Decoded {
    let altitude_m = fields.metres()?;
    fields.unit(b"M")?;
    let dbar = fields.measure()?;
    if dbar.is_some() {
        fields.unit(b"dBar")?;
    }
    Ok(Navigation { depth_m: dbar.map(|dbar| depth_m(settings, dbar)), altitude_m, ..Navigation::default() })
}

/// `value,unit`. Without its unit the value may be either, and tells nothing.
fn pressure_or_depth(settings: &NmeaSettings, mut fields: Fields<'_>) -> Decoded {
    let value = fields.measure()?;
    let depth_m = match fields.text() {
        b"M" => value.map(|value| value as f32),
        b"dBar" => value.map(|dbar| depth_m(settings, dbar)),
        _ => None,
    };
    Ok(Navigation { depth_m, ..Navigation::default() })
}

/// `address,serial number,pressure,d,depth,unit`.
fn depth_behind_pressure(mut fields: Fields<'_>) -> Decoded {
    fields.skip(4);
    let depth_m = fields.metres()?;
    let depth_m = if fields.text() == b"M" { depth_m } else { None };
    Ok(Navigation { depth_m, ..Navigation::default() })
}

fn depth_m(settings: &NmeaSettings, dbar: f64) -> f32 {
    ((dbar - settings.surface_dbar) * M_PER_DBAR) as f32
}

/// `time,ddmm.mm,N,dddmm.mm,E,fix`.
fn position(mut fields: Fields<'_>) -> Decoded {
    fields.skip(1);
    let (latitude_e7, longitude_e7) = (fields.angle(90, [b"N", b"S"])?, fields.angle(180, [b"E", b"W"])?);
    let fix = match fields.text() {
        &[digit @ b'0'..=b'8'] => digit - b'0',
        _ => return Err(Malformed),
    };
    let (Some(latitude_e7), Some(longitude_e7), 1..) = (latitude_e7, longitude_e7, fix) else {
        return Ok(Navigation::default());
    };
    Ok(Navigation { position: Some(Position { latitude_e7, longitude_e7, fix }), ..Navigation::default() })
}

fn heading(mut fields: Fields<'_>, unit: &[u8], is_magnetic: bool) -> Decoded {
    let Some(deg) = fields.degrees(360.0)? else { return Ok(Navigation::default()) };
    fields.unit(unit)?;
    Ok(turned(deg, is_magnetic))
}

/// `heading,deviation,E,variation,E`: true where the variation is there.
fn heading_with_variation(mut fields: Fields<'_>) -> Decoded {
    let Some(deg) = fields.degrees(360.0)? else { return Ok(Navigation::default()) };
    let (deviation_deg, variation_deg) = (fields.east()?, fields.east()?);
    let sum_deg = deg + deviation_deg.unwrap_or(0.0) + variation_deg.unwrap_or(0.0);
    Ok(turned(sum_deg, variation_deg.is_none()))
}

/// A heading within one turn.
fn turned(deg: f64, is_magnetic: bool) -> Navigation {
    let deg = (deg - 360.0 * libm::floor(deg / 360.0)) as f32;
    Navigation { heading: Some(Heading { deg, is_magnetic }), ..Navigation::default() }
}

/// The fields that are left. Beyond the last all are empty; an empty one stands for a value that the sensor does not have.
#[derive(Clone, Copy)]
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn text(&mut self) -> &'a [u8] {
        let end = self.0.iter().position(|&byte| byte == b',');
        let (text, rest) = self.0.split_at(end.unwrap_or(self.0.len()));
        self.0 = rest.get(1..).unwrap_or_default();
        text.trim_ascii()
    }

    fn skip(&mut self, fields: u8) {
        for _ in 0..fields {
            self.text();
        }
    }

    fn unit(&mut self, unit: &[u8]) -> Result<(), Malformed> {
        if self.text() == unit { Ok(()) } else { Err(Malformed) }
    }

    /// A decimal number as NMEA has it, without an exponent.
    fn number(&mut self) -> Result<Option<f64>, Malformed> {
        let text = self.text();
        let is_decimal = |(place, byte): (usize, &u8)| match byte {
            b'0'..=b'9' | b'.' => true,
            b'-' | b'+' => place == 0,
            _ => false,
        };
        match text {
            [] => Ok(None),
            _ if !text.iter().enumerate().all(is_decimal) => Err(Malformed),
            _ => lexical_core::parse(text).map(Some).map_err(|_| Malformed),
        }
    }

    fn within(&mut self, range: core::ops::RangeInclusive<f64>) -> Result<Option<f64>, Malformed> {
        let number = self.number()?;
        if number.is_none_or(|number| range.contains(&number)) { Ok(number) } else { Err(Malformed) }
    }

    /// A depth, an altitude or a pressure; a little above the surface a pressure sensor shows less than nothing.
    fn measure(&mut self) -> Result<Option<f64>, Malformed> {
        self.within(-100.0..=LONGEST_M)
    }

    fn metres(&mut self) -> Result<Option<f32>, Malformed> {
        Ok(self.measure()?.map(|metres| metres as f32))
    }

    fn degrees(&mut self, most: f64) -> Result<Option<f64>, Malformed> {
        self.within(0.0..=most)
    }

    /// Degrees with `E` or `W`, positive to the east.
    fn east(&mut self) -> Result<Option<f64>, Malformed> {
        let deg = self.degrees(180.0)?;
        match (deg, self.text()) {
            (None, _) => Ok(None),
            (deg, b"E") => Ok(deg),
            (Some(deg), b"W") => Ok(Some(-deg)),
            _ => Err(Malformed),
        }
    }

    /// Degrees and minutes, `ddmm.mm`, and a hemisphere, of which the second is negative; in 1e-7 degrees.
    fn angle(&mut self, most_deg: u8, [positive, negative]: [&[u8]; 2]) -> Result<Option<i32>, Malformed> {
        let most_deg = f64::from(most_deg);
        let value = self.within(0.0..=most_deg * 100.0)?;
        let hemisphere = self.text();
        let Some(value) = value else { return Ok(None) };
        let whole_deg = libm::floor(value / 100.0);
        let minutes = value - whole_deg * 100.0;
        if minutes >= 60.0 {
            return Err(Malformed);
        }
        let angle_e7 = libm::round((whole_deg + minutes / 60.0) * 1e7) as i32; // at most 1.8e9
        match hemisphere {
            _ if hemisphere == positive => Ok(Some(angle_e7)),
            _ if hemisphere == negative => Ok(Some(-angle_e7)),
            _ => Err(Malformed),
        }
    }
}
