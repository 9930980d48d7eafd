//! The fields of a sentence, read from left to right.

/// Analogue channels beyond the signal that a reading keeps: depth and altitude of a G-882.
pub const CHANNELS: usize = 2;

/// What a format's decoder makes of a sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// Total field, picotesla.
    pub scalar_pt: i32,
    /// Signal strength in the sensor's own units, if the sentence carries it.
    pub signal: Option<u32>,
    /// The sensor's own count of sentences, if it sends one.
    pub counter: Option<u32>,
    /// Analogue channels beyond the signal, raw, as far as the sentence carries them.
    pub channels: [Option<u16>; CHANNELS],
    /// Whether the sensor itself takes the reading for valid.
    pub marker: Marker,
}

/// The sensor's own judgement. Formats without one say valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Nothing speaks against the reading.
    Valid,
    /// The sensor flags the reading, or leaves unmarked what it should mark.
    Invalid,
}

/// Why a sentence cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// It stops short.
    Cut,
    /// A number is none, or is too large.
    BadNumber,
    /// It is otherwise not of the format's form.
    Malformed,
}

/// What is left of a sentence.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a> {
    rest: &'a [u8],
}

impl<'a> Fields<'a> {
    /// All of a sentence.
    pub fn new(text: &'a [u8]) -> Self {
        Self { rest: text }
    }

    /// The next byte, which stays.
    pub fn peek(&self) -> Option<u8> {
        self.rest.first().copied()
    }

    /// The next byte, which is taken.
    pub fn next_byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    /// Whether the next byte is this one; if so, it is taken.
    pub fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        if found {
            self.next_byte();
        }
        found
    }

    /// Take this byte.
    pub fn expect(&mut self, byte: u8) -> Result<(), Defect> {
        match self.next_byte() {
            None => Err(Defect::Cut),
            Some(found) if found == byte => Ok(()),
            Some(_) => Err(Defect::Malformed),
        }
    }

    /// Take these bytes, one after the other.
    pub fn expect_all(&mut self, bytes: &[u8]) -> Result<(), Defect> {
        bytes.iter().try_for_each(|&byte| self.expect(byte))
    }

    /// Nothing may be left.
    pub fn end(&self) -> Result<(), Defect> {
        if self.rest.is_empty() { Ok(()) } else { Err(Defect::Malformed) }
    }

    /// Exactly this many digits, at most nine.
    pub fn digits(&mut self, count: u8) -> Result<u32, Defect> {
        let mut value = 0;
        for _ in 0..count {
            let digit = self.next_byte().ok_or(Defect::Cut)?;
            value = append(value, digit)?;
        }
        Ok(value)
    }

    /// As many digits as there are, at least one.
    pub fn number(&mut self) -> Result<u32, Defect> {
        let first = self.next_byte().ok_or(Defect::Cut)?;
        let mut value = append(0, first)?;
        while let Some(digit) = self.peek().filter(u8::is_ascii_digit) {
            self.next_byte();
            value = append(value, digit)?;
        }
        Ok(value)
    }

    /// A decimal number with or without sign and fraction, of any size: its form is checked, its value not wanted.
    pub fn skip_decimal(&mut self) -> Result<(), Defect> {
        let _ = self.take(b'-') || self.take(b'+');
        self.skip_digits()?;
        if self.take(b'.') { self.skip_digits() } else { Ok(()) }
    }

    fn skip_digits(&mut self) -> Result<(), Defect> {
        let digits = self.rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        self.rest = self.rest.get(digits..).unwrap_or(&[]);
        match (digits, self.rest.is_empty()) {
            (0, true) => Err(Defect::Cut),
            (0, false) => Err(Defect::BadNumber),
            _ => Ok(()),
        }
    }
}

fn append(value: u32, digit: u8) -> Result<u32, Defect> {
    if !digit.is_ascii_digit() {
        return Err(Defect::BadNumber);
    }
    value.checked_mul(10).and_then(|tens| tens.checked_add(u32::from(digit - b'0'))).ok_or(Defect::BadNumber)
}
