//! Sentences of NMEA 0183, as a sensor sends them.

/// A sentence with its checksum.
pub fn sealed(content: &str) -> Vec<u8> {
    format!("${content}*{:02X}\r\n", content.bytes().fold(0, |sum, byte| sum ^ byte)).into_bytes()
}
