//! Marine Magnetics SeaSPY, SeaSPY2 and Explorer (Overhauser), standard text format.
//!
//! `*YY.JJJ/HH:MM:SS.S F:FFFFFF.FFF S:SSS D:+DDD.Dm A:AAA.A L:L TTTms_Q:QQ !!!!`, then CR LF: year and day, time, field
//! in nT, signal, depth, altitude, leak, time of measurement, quality. 9600 8N1.
//!
//! The maker's manuals were not at hand. The form is that of <https://github.com/HughF/magview>, `docs/PROTOCOL.md` at
//! a6767caa, taken there from the operation manuals of the Explorer and the SeaSPY2 and without a recorded line; a reader
//! of SeaSPY2 files that another survey wrote agrees with it up to `S:`, and shows an `m` after the altitude. Therefore:
//!
//! - What comes after `S:` and a blank depends on what is fitted. It is passed over, and neither leak nor quality makes
//!   a reading invalid.
//! - The field has six digits before the point in that form and five in its own examples: a setting, as a lost digit
//!   would otherwise be a plausible field.
//! - The sources disagree on which signal is weak: any passes.
//! - GPS lines that the sensor passes through are counted as rubbish and a cut sentence each.

use super::fields::{CHANNELS, Decoded, Defect, Fields, Marker};
use super::format::{Format, FormatParameter, Sensor, Value};
use super::line::Framing;
use super::scale::Scale;
use crate::sensors::check;

/// Digits of the field before its point, 5 or 6; zeros on the left fill them up.
const DIGITS: FormatParameter = FormatParameter { name: "seaspy_digits", default: Value::Small(6) };

/// The format.
pub static FORMAT: Format = Format {
    name: "seaspy",
    title: "Marine Magnetics SeaSPY, SeaSPY2 or Explorer, standard text format",
    tag: 4,
    baud: 9_600,
    weakest_signal: 0,
    strongest_signal: u32::MAX,
    parameters: &[DIGITS],
    framing: Framing { start: b'*', other_lines: &[] },
    check: |values| {
        check("seaspy_digits", values.byte(0).into(), 5.0..=6.0, "5 or 6")?;
        Ok(Scale::Decimals(3))
    },
    decode,
    #[cfg(not(target_os = "none"))]
    encode,
};

fn decode(sensor: &Sensor, text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    date_and_time(&mut fields)?;
    fields.expect_all(b" F:")?;
    let nt = fields.digits(sensor.values.byte(0))?;
    fields.expect(b'.')?;
    let pt = fields.digits(3)?;
    fields.expect_all(b" S:")?;
    let signal = fields.number()?;
    // Without the blank, the signal may have lost its last digits.
    fields.expect(b' ')?;
    Ok(Decoded {
        scalar_pt: (nt * 1_000 + pt) as i32, // at most 999,999,999
        signal: Some(signal),
        counter: None,
        channels: [None; CHANNELS],
        marker: Marker::Valid,
    })
}

/// Checked for its form and passed over: the timer stamps are better.
fn date_and_time(fields: &mut Fields<'_>) -> Result<(), Defect> {
    for (digits, end) in [(2, b'.'), (3, b'/'), (2, b':'), (2, b':'), (2, b'.')] {
        fields.digits(digits)?;
        fields.expect(end)?;
    }
    fields.digits(1)?;
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn encode(sensor: &Sensor, scalar_pt: i32, out: &mut dyn core::fmt::Write) -> core::fmt::Result {
    let (nt, pt, width) = (scalar_pt / 1_000, scalar_pt % 1_000, usize::from(sensor.values.byte(0)));
    write!(out, "*26.001/00:00:00.0 F:{nt:0width$}.{pt:03} S:1000 D:+000.0m L:0 250ms_Q:99 !!!!\r\n")
}
