//! Geometrics G-882, G-822A and G-823 (caesium) with the CM-221 counter.
//!
//! `$` | blank, or `1` from 100,000 nT up | five digits `.` three digits, nT | one to eight times `,` four digits |
//! optionally `,DxxxHxxMxxSxx_xx` | CR LF. The first analogue channel is the Larmor signal, 9999 being 5 V (G-882 manual
//! p. 46, 47; Julian clock: G-822A manual p. 27). Where they are fitted, the next two are depth and altitude (p. 46, 83).
//!
//! In a daisy chain only the first counter sends `$`, and a comma stands in place of each line end but the last (p. 47).
//! How the second counter's field then looks no source confirms: such a line is refused and counted as malformed.

use super::fields::{CHANNELS, Decoded, Defect, Fields, Marker};
use super::format::{Format, Sensor};
use super::line::Framing;
use super::scale::Scale;

/// The format. The weakest signal is the manual's limit for a sensor that is well oriented (p. 94); in poor orientation
/// the sensor may go on working below it.
pub static FORMAT: Format = Format {
    name: "g882",
    title: "Geometrics G-882, G-822A or G-823 with the CM-221 counter",
    tag: 0,
    baud: 9_600,
    weakest_signal: 800,
    strongest_signal: u32::MAX,
    parameters: &[],
    framing: Framing { start: b'$', other_lines: &[] },
    check: |_| Ok(Scale::Decimals(3)),
    decode,
    #[cfg(not(target_os = "none"))]
    encode,
};

const MOST_ANALOGUE_CHANNELS: usize = 8;

fn decode(_: &Sensor, text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    let scalar_pt = field_pt(&mut fields)?;
    let signal = analogue(&mut fields)?;
    let mut channels = [None; CHANNELS];
    for channel in 1..MOST_ANALOGUE_CHANNELS {
        if fields.peek().is_none() || next_is_clock(fields) {
            break;
        }
        let raw = analogue(&mut fields)?;
        if let Some(place) = channels.get_mut(channel - 1) {
            *place = Some(raw);
        }
    }
    if fields.peek().is_some() {
        clock(&mut fields)?;
    }
    fields.end()?;
    Ok(Decoded { scalar_pt, signal: Some(signal.into()), counter: None, channels, marker: Marker::Valid })
}

fn field_pt(fields: &mut Fields<'_>) -> Result<i32, Defect> {
    let hundred_thousands = match fields.next_byte().ok_or(Defect::Cut)? {
        b' ' => 0,
        b'1' => 1,
        _ => return Err(Defect::BadNumber),
    };
    let nt = fields.digits(5)?;
    fields.expect(b'.')?;
    let pt = fields.digits(3)?;
    Ok((hundred_thousands * 100_000_000 + nt * 1_000 + pt) as i32) // at most 199,999,999
}

fn analogue(fields: &mut Fields<'_>) -> Result<u16, Defect> {
    fields.expect(b',')?;
    Ok(fields.digits(4)? as u16) // at most 9,999
}

fn next_is_clock(mut fields: Fields<'_>) -> bool {
    fields.take(b',') && fields.take(b'D')
}

/// The Julian clock is checked for its form and passed over: it is set by hand, and the timer stamps are better.
fn clock(fields: &mut Fields<'_>) -> Result<(), Defect> {
    fields.expect(b',')?;
    for (letter, digits) in [(b'D', 3), (b'H', 2), (b'M', 2), (b'S', 2), (b'_', 2)] {
        fields.expect(letter)?;
        fields.digits(digits)?;
    }
    Ok(())
}

/// With a signal that is neither weak nor strong, 1 V.
#[cfg(not(target_os = "none"))]
fn encode(_: &Sensor, scalar_pt: i32, out: &mut dyn core::fmt::Write) -> core::fmt::Result {
    let hundred_thousands = if scalar_pt < 100_000_000 { ' ' } else { '1' };
    let (nt, pt) = (scalar_pt / 1_000 % 100_000, scalar_pt % 1_000);
    write!(out, "${hundred_thousands}{nt:05}.{pt:03},2000\r\n")
}
