//! QuSpin QTFM Gen-2 (rubidium).
//!
//! `!{Magdata}Y{Vectordata}@{Datacounter}>{Timestamp}s{Scalar Sensitivity}v{Vector Sensitivity}`, then CR LF; the vector's
//! letter is X, Y or Z in turn and each item can be switched off, so that items are told by their letters. Lines that
//! start with `#` are status, with `)` `(` `+` `=` for the maker's own program
//! (<http://quspin.com/serial-communication-and-data-format>).
//!
//! The page does not show the unit of `Magdata`, nor the marks of validity. Recorded lines
//! (`!51318.312_X17130.334=>141949s054v076i0.43j-0.49k0.49`) have decimal nanotesla and a `_` after it; that `*`
//! stands there when the reading is invalid comes from a simulator alone. All three are settings.

use super::fields::{CHANNELS, Decoded, Defect, Fields, Marker};
use super::format::{Format, FormatParameter, Sensor, Value, Values};
use super::line::Framing;
use super::qtfm_gen1::COUNTS_PARAMETER;
use super::scale::Scale;
use crate::settings::SettingsError;

/// Decimals of a field in nanotesla, 0 to 6.
const DECIMALS: FormatParameter = FormatParameter { name: "gen2_decimals", default: Value::Small(3) };
/// Printable byte after the field that says valid; no digit, no letter.
const VALID_MARK: FormatParameter = FormatParameter { name: "gen2_valid_mark", default: Value::Mark(b'_') };
/// Printable byte after the field that says invalid; no digit, no letter.
const INVALID_MARK: FormatParameter = FormatParameter { name: "gen2_invalid_mark", default: Value::Mark(b'*') };
/// Whether a reading without either mark is invalid.
const MARK_REQUIRED: FormatParameter = FormatParameter { name: "gen2_mark_required", default: Value::Switch(true) };

/// The format as in recorded lines. No source gives limits of its signal: any passes.
pub static FORMAT: Format = Format {
    name: "qtfm-gen2",
    title: "QuSpin QTFM Gen-2, field in nanotesla",
    tag: 2,
    baud: 115_200,
    weakest_signal: 0,
    strongest_signal: u32::MAX,
    parameters: &[DECIMALS, VALID_MARK, INVALID_MARK, MARK_REQUIRED],
    framing: FRAMING,
    check: |values| {
        let scale = Scale::decimals(values.byte(0))?;
        check_marks(values)?;
        Ok(scale)
    },
    decode,
    #[cfg(not(target_os = "none"))]
    encode,
};

/// The same with integer counts, as of the Gen-1.
pub static COUNTS: Format = Format {
    name: "qtfm-gen2-counts",
    title: "QuSpin QTFM Gen-2, field in counts",
    tag: 3,
    baud: 115_200,
    weakest_signal: 0,
    strongest_signal: u32::MAX,
    parameters: &[COUNTS_PARAMETER, VALID_MARK, INVALID_MARK, MARK_REQUIRED],
    framing: FRAMING,
    check: |values| {
        let scale = Scale::counts(values.number(0))?;
        check_marks(values)?;
        Ok(scale)
    },
    decode,
    #[cfg(not(target_os = "none"))]
    encode,
};

const FRAMING: Framing = Framing { start: b'!', other_lines: b"#)(+=" };

/// The marks, which lie at the same places in both.
fn marks(values: &Values) -> [u8; 2] {
    [values.byte(1), values.byte(2)]
}

fn check_marks(values: &Values) -> Result<(), SettingsError> {
    let [valid_mark, invalid_mark] = marks(values);
    for (name, mark) in [("valid_mark", valid_mark), ("invalid_mark", invalid_mark)] {
        if !mark.is_ascii_punctuation() || b"!@>.+-".contains(&mark) {
            let allowed = "the ASCII code of a punctuation mark other than ! @ > . + -";
            return Err(SettingsError::OutOfRange { name, value: mark.into(), allowed });
        }
    }
    if valid_mark == invalid_mark {
        let (name, allowed) = ("invalid_mark", "another than valid_mark");
        return Err(SettingsError::OutOfRange { name, value: invalid_mark.into(), allowed });
    }
    Ok(())
}

fn decode(sensor: &Sensor, text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    let scalar_pt = sensor.scale.read(&mut fields)?;
    let marker = marker(&sensor.values, &mut fields);
    let mut items = Items::default();
    while let Some(letter) = fields.next_byte() {
        items.read(letter, &mut fields)?;
    }
    Ok(Decoded { scalar_pt, signal: items.signal, counter: items.counter, channels: [None; CHANNELS], marker })
}

fn marker(values: &Values, fields: &mut Fields<'_>) -> Marker {
    let [valid_mark, invalid_mark] = marks(values);
    if fields.take(valid_mark) {
        Marker::Valid
    } else if fields.take(invalid_mark) || values.is_on(3) {
        Marker::Invalid
    } else {
        Marker::Valid
    }
}

/// Items that may come once in a sentence; X, Y and Z share one place as only one comes in a line.
#[derive(Clone, Copy, Debug, Default)]
struct Items {
    counter: Option<u32>,
    signal: Option<u32>,
    vector: bool,
    time: bool,
}

impl Items {
    /// One item. An unknown letter is passed over if a number follows it; an item that comes twice shows that two lines
    /// have run together.
    fn read(&mut self, letter: u8, fields: &mut Fields<'_>) -> Result<(), Defect> {
        match letter {
            b'@' => once(&mut self.counter, fields.number()?),
            b's' => once(&mut self.signal, fields.number()?),
            b'X' | b'Y' | b'Z' if !core::mem::replace(&mut self.vector, true) => {
                fields.skip_decimal()?;
                // Valid or not: the vector is not used, the fluxgate is better.
                let _ = fields.take(b'=') || fields.take(b'?');
                Ok(())
            }
            b'>' if !core::mem::replace(&mut self.time, true) => fields.skip_decimal(),
            b'X' | b'Y' | b'Z' | b'>' => Err(Defect::Malformed),
            letter if letter.is_ascii_alphabetic() => fields.skip_decimal(),
            _ => Err(Defect::Malformed),
        }
    }
}

fn once(place: &mut Option<u32>, value: u32) -> Result<(), Defect> {
    if place.replace(value).is_some() { Err(Defect::Malformed) } else { Ok(()) }
}

#[cfg(not(target_os = "none"))]
fn encode(sensor: &Sensor, scalar_pt: i32, out: &mut dyn core::fmt::Write) -> core::fmt::Result {
    let [valid_mark, _] = marks(&sensor.values);
    out.write_str("!")?;
    sensor.scale.write(scalar_pt, out)?;
    write!(out, "{}\r\n", char::from(valid_mark))
}
