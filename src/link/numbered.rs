//! Commands with a number and a check sum, as a program sends them: `#12 set lambda1 0.002*1662dfce`.
//!
//! The eight digits are the CRC-32 (ISO-HDLC) of what stands between `#` and `*`. A line that begins with `#` and does not
//! fit its CRC is damaged and does nothing. The body acknowledges the number before it answers, and does a number that it
//! has just done no second time, so that a line whose acknowledgement was lost can be sent again.

use super::command::LONGEST_LINE;
use crc::{CRC_32_ISO_HDLC, Crc};

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// A numbered line as it goes over the wire, without a line end.
pub type NumberedLine = heapless::String<LONGEST_LINE>;

/// The line for a command; `None` when it is longer than [`LONGEST_LINE`].
pub fn numbered(number: u16, command: &str) -> Option<NumberedLine> {
    use core::fmt::Write;
    let mut line = NumberedLine::new();
    write!(line, "#{number} {command}").ok()?;
    let crc = CRC.checksum(line.get(1..)?.as_bytes());
    write!(line, "*{crc:08x}").ok()?;
    Some(line)
}

/// Number and command of a line that follows a `#`; `None` when it does not fit its CRC.
pub(super) fn unpack(line: &str) -> Option<(u16, &str)> {
    let (content, crc) = line.rsplit_once('*')?;
    let fits = crc.len() == 8 && u32::from_str_radix(crc, 16).is_ok_and(|crc| crc == CRC.checksum(content.as_bytes()));
    let (number, command) = content.split_once(' ')?;
    Some((number.parse().ok().filter(|_| fits)?, command))
}

/// What the body answers to the number, in a line of its own, before the answer itself.
pub fn acknowledgement(number: u16) -> heapless::String<16> {
    use core::fmt::Write;
    let mut line = heapless::String::new();
    // Nine bytes at most.
    _ = write!(line, "#{number} ok");
    line
}

/// The number that a line acknowledges.
pub fn acknowledged(line: &str) -> Option<u16> {
    line.strip_prefix('#')?.strip_suffix(" ok")?.parse().ok()
}
