//! Geometrics G-882, G-822A and G-823 (caesium) with the CM-221 counter.
//!
//! `$` | blank, or `1` from 100,000 nT up | five digits `.` three digits, nT | one to eight times `,` four digits |
//! optionally `,DxxxHxxMxxSxx_xx` | CR LF. The first analogue channel is the Larmor signal, 9999 being 5 V (G-882 manual
//! p. 46, 47; Julian clock: G-822A manual p. 27).
//!
//! In a daisy chain only the first counter sends `$`, and a comma stands in place of each line end but the last (p. 47).
//! How the second counter's field then looks no source confirms: such a line is refused and counted as malformed.

use super::fields::{Decoded, Defect, Fields, Marker};
use super::line::Framing;

pub(super) const FRAMING: Framing = Framing { start: b'$', other_lines: &[] };

const MOST_ANALOGUE_CHANNELS: usize = 8;

pub(super) fn decode(text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    let scalar_pt = field_pt(&mut fields)?;
    let signal = analogue(&mut fields)?;
    for _ in 1..MOST_ANALOGUE_CHANNELS {
        if fields.peek().is_none() || next_is_clock(fields) {
            break;
        }
        analogue(&mut fields)?;
    }
    if fields.peek().is_some() {
        clock(&mut fields)?;
    }
    fields.end()?;
    Ok(Decoded { scalar_pt, signal: Some(signal), counter: None, marker: Marker::Valid })
}

fn field_pt(fields: &mut Fields<'_>) -> Result<i32, Defect> {
    let hundred_thousands = match fields.next().ok_or(Defect::Cut)? {
        b' ' => 0,
        b'1' => 1,
        _ => return Err(Defect::BadNumber),
    };
    let nt = fields.digits(5)?;
    fields.expect(b'.')?;
    let pt = fields.digits(3)?;
    Ok((hundred_thousands * 100_000_000 + nt * 1_000 + pt) as i32) // at most 199,999,999
}

fn analogue(fields: &mut Fields<'_>) -> Result<u32, Defect> {
    fields.expect(b',')?;
    fields.digits(4)
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
