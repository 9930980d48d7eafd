//! QuSpin QTFM Gen-1 (rubidium).
//!
//! `!magdata`, `!magdata@signalstrength` or `!magdata@signalstrength^cyclecounter`, by decimation, then CR LF; lines that
//! start with `#` (status) or `*` (lamp code) are no data (<http://quspin.com/qtfm/qtfm-serial-communication/>, 2017).

use super::count_scale::CountScale;
use super::fields::{Decoded, Defect, Fields, Marker};
use super::line::Framing;

pub(super) const FRAMING: Framing = Framing { start: b'!', other_lines: b"#*" };

pub(super) fn decode(scale: CountScale, text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    let scalar_pt = scale.to_pt(fields.number()?)?;
    let signal = if fields.take(b'@') { Some(fields.number()?) } else { None };
    let counter = if signal.is_some() && fields.take(b'^') { Some(fields.number()?) } else { None };
    fields.end()?;
    Ok(Decoded { scalar_pt, signal, counter, marker: Marker::Valid })
}
