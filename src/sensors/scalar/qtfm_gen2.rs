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

use super::count_scale::CountScale;
use super::fields::{Decoded, Defect, Fields, Marker};
use super::line::Framing;
use crate::sensors::check;
use crate::settings::SettingsError;

pub(super) const FRAMING: Framing = Framing { start: b'!', other_lines: b"#)(+=" };

/// How `Magdata` is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Magdata {
    /// Nanotesla with exactly this many decimals, 0 to 6. A number with another count of decimals is refused, since
    /// it may have lost a digit.
    Nanotesla {
        /// Decimals after the point; no point for none.
        decimals: u8,
    },
    /// An integer count, as of the Gen-1.
    Counts {
        /// Counts per nanotesla, 1 to 1,000,000.
        counts_per_nt: f64,
    },
}

/// What no page of the maker confirms about the format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QtfmGen2Settings {
    /// How the field is written.
    pub magdata: Magdata,
    /// Printable byte after the field that says valid; no digit, no letter.
    pub valid_mark: u8,
    /// Printable byte after the field that says invalid; no digit, no letter.
    pub invalid_mark: u8,
    /// Whether a reading without either mark is invalid.
    pub mark_required: bool,
}

impl QtfmGen2Settings {
    /// As in recorded lines.
    pub const RECORDED: Self =
        Self { magdata: Magdata::Nanotesla { decimals: 3 }, valid_mark: b'_', invalid_mark: b'*', mark_required: true };
}

#[derive(Clone, Copy, Debug)]
enum Scale {
    Decimals(u8),
    Counts(CountScale),
}

/// A checked [`QtfmGen2Settings`].
#[derive(Clone, Copy, Debug)]
pub(super) struct QtfmGen2 {
    scale: Scale,
    settings: QtfmGen2Settings,
}

/// Items that may come once in a sentence; X, Y and Z share one place as only one comes in a line.
#[derive(Clone, Copy, Debug, Default)]
struct Items {
    counter: Option<u32>,
    signal: Option<u32>,
    vector: bool,
    time: bool,
}

impl QtfmGen2 {
    pub(super) fn new(settings: QtfmGen2Settings) -> Result<Self, SettingsError> {
        let scale = match settings.magdata {
            Magdata::Nanotesla { decimals } => {
                check("decimals", decimals.into(), 0.0..=6.0, "0 to 6")?;
                Scale::Decimals(decimals)
            }
            Magdata::Counts { counts_per_nt } => Scale::Counts(CountScale::new(counts_per_nt)?),
        };
        let QtfmGen2Settings { valid_mark, invalid_mark, .. } = settings;
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
        Ok(Self { scale, settings })
    }

    pub(super) fn decode(&self, text: &[u8]) -> Result<Decoded, Defect> {
        let mut fields = Fields::new(text);
        let scalar_pt = match self.scale {
            Scale::Decimals(decimals) => decimal_pt(&mut fields, decimals)?,
            Scale::Counts(scale) => scale.to_pt(fields.number()?)?,
        };
        let marker = self.marker(&mut fields);
        let mut items = Items::default();
        while let Some(letter) = fields.next() {
            items.read(letter, &mut fields)?;
        }
        Ok(Decoded { scalar_pt, signal: items.signal, counter: items.counter, marker })
    }

    fn marker(&self, fields: &mut Fields<'_>) -> Marker {
        if fields.take(self.settings.valid_mark) {
            Marker::Valid
        } else if fields.take(self.settings.invalid_mark) || self.settings.mark_required {
            Marker::Invalid
        } else {
            Marker::Valid
        }
    }
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

/// Decimal nanotesla, rounded to the nearest picotesla.
fn decimal_pt(fields: &mut Fields<'_>, decimals: u8) -> Result<i32, Defect> {
    let nt = fields.number()?;
    let fraction = if decimals == 0 {
        0
    } else {
        fields.expect(b'.')?;
        fields.digits(decimals)?
    };
    // In 1e-6 nT: below 2^32 * 1e6 + 1e6 < 2^63.
    let micro_nt =
        i64::from(nt) * 1_000_000 + i64::from(fraction) * 10_i64.pow(u32::from(6_u8.saturating_sub(decimals)));
    i32::try_from((micro_nt + 500) / 1_000).map_err(|_| Defect::BadNumber)
}
