//! What can go wrong with a sentence.

/// Longest sentence between start byte and line end, bytes. The longest that the formats allow is a G-882 line with
/// eight analogue channels and the Julian clock, 67.
pub const LONGEST_SENTENCE: usize = 96;

/// What went wrong on the line since the start. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScalarFaults {
    /// Bytes that belong to no line of the format.
    pub rubbish_bytes: u32,
    /// Sentences that stop short, or are broken off by the start of another or by a byte that is no text.
    pub cut_lines: u32,
    /// Sentences longer than [`LONGEST_SENTENCE`].
    pub overlong: u32,
    /// Sentences whose number is none, or is too large.
    pub bad_number: u32,
    /// Sentences that are otherwise not of the format's form. A daisy-chained G-882 line is one.
    pub malformed: u32,
    /// Readings outside the accepted range of the field.
    pub out_of_range: u32,
    /// Readings whose signal is outside its limits.
    pub signal_out_of_limits: u32,
    /// Readings that the sensor flags as invalid, or leaves unmarked though it should mark them.
    pub flagged_invalid: u32,
    /// Bytes lost because they were not fetched in time.
    pub overruns: u32,
    /// Bytes with a wrong stop bit: wrong baud rate, break, or a bad cable.
    pub framing_errors: u32,
    /// Bytes with noise, wrong parity or another error of the receiver.
    pub other_receive_errors: u32,
}
