//! QuSpin QTFM Gen-1 (rubidium).
//!
//! `!magdata`, `!magdata@signalstrength` or `!magdata@signalstrength^cyclecounter`, by decimation, then CR LF; lines that
//! start with `#` (status) or `*` (lamp code) are no data (<http://quspin.com/qtfm/qtfm-serial-communication/>, 2017).

use super::fields::{CHANNELS, Decoded, Defect, Fields, Marker};
use super::format::{Format, FormatParameter, Sensor, Value};
use super::line::Framing;
use super::scale::Scale;

/// The maker's scale.
const COUNTS_PER_NT: f64 = 6009.342147;

/// Counts per nanotesla, 1 to 1,000,000.
pub(super) const COUNTS_PARAMETER: FormatParameter =
    FormatParameter { name: "counts_per_nt", default: Value::Number(COUNTS_PER_NT) };

/// The format. No source gives limits of its signal: any passes.
pub static FORMAT: Format = Format {
    name: "qtfm-gen1",
    title: "QuSpin QTFM Gen-1",
    tag: 1,
    baud: 115_200,
    weakest_signal: 0,
    strongest_signal: u32::MAX,
    parameters: &[COUNTS_PARAMETER],
    framing: Framing { start: b'!', other_lines: b"#*" },
    check: |values| Scale::counts(values.number(0)),
    decode,
    #[cfg(not(target_os = "none"))]
    encode,
};

fn decode(sensor: &Sensor, text: &[u8]) -> Result<Decoded, Defect> {
    let mut fields = Fields::new(text);
    let scalar_pt = sensor.scale.read(&mut fields)?;
    let signal = if fields.take(b'@') { Some(fields.number()?) } else { None };
    let counter = if signal.is_some() && fields.take(b'^') { Some(fields.number()?) } else { None };
    fields.end()?;
    Ok(Decoded { scalar_pt, signal, counter, channels: [None; CHANNELS], marker: Marker::Valid })
}

#[cfg(not(target_os = "none"))]
fn encode(sensor: &Sensor, scalar_pt: i32, out: &mut dyn core::fmt::Write) -> core::fmt::Result {
    out.write_str("!")?;
    sensor.scale.write(scalar_pt, out)?;
    out.write_str("\r\n")
}
