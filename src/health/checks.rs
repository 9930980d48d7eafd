//! What the parts of the body have found out about themselves, for the [self-test](crate::self_test).

use crate::sensors::ads131m04::AdcError;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

/// What became of the converter's set-up, or of the latest look at its identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConverterCheck {
    /// It was not tried yet.
    NotTried,
    /// Its CRC is right, and it is the right chip.
    Passed {
        /// Its ID register.
        id: u16,
    },
    /// It does not answer a reset as it should: absent, not clocked, or wired wrongly.
    NoAnswer {
        /// What it answered.
        response: u16,
    },
    /// Another chip answers.
    OtherChip {
        /// Its ID register.
        id: u16,
    },
    /// What it answers has a wrong CRC.
    Damaged,
    /// Its registers do not keep what is written.
    Refuses,
    /// The bus failed.
    Bus,
}

impl From<Option<Result<u16, AdcError>>> for ConverterCheck {
    fn from(tried: Option<Result<u16, AdcError>>) -> Self {
        match tried {
            None => Self::NotTried,
            Some(Ok(id)) => Self::Passed { id },
            Some(Err(AdcError::NoReset { response })) => Self::NoAnswer { response },
            Some(Err(AdcError::WrongId { id })) => Self::OtherChip { id },
            Some(Err(AdcError::Crc(_))) => Self::Damaged,
            Some(Err(AdcError::Spi(_))) => Self::Bus,
            Some(Err(_)) => Self::Refuses,
        }
    }
}

impl ConverterCheck {
    /// A number of 16 bits, and which kind it is of above them.
    fn code(self) -> u32 {
        let (kind, word) = match self {
            Self::NotTried => (0, 0),
            Self::Passed { id } => (1, id),
            Self::NoAnswer { response } => (2, response),
            Self::OtherChip { id } => (3, id),
            Self::Damaged => (4, 0),
            Self::Refuses => (5, 0),
            Self::Bus => (6, 0),
        };
        kind << 16 | u32::from(word)
    }

    fn of(code: u32) -> Self {
        let word = code as u16;
        match code >> 16 {
            1 => Self::Passed { id: word },
            2 => Self::NoAnswer { response: word },
            3 => Self::OtherChip { id: word },
            4 => Self::Damaged,
            5 => Self::Refuses,
            6 => Self::Bus,
            _ => Self::NotTried,
        }
    }
}

/// What the card has shown since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CardCheck {
    /// Room of the card that was found last, blocks of 512 bytes; 0 when there was none.
    pub blocks: u32,
    /// Writes that it took, of one block or several.
    pub writes: u32,
    /// The write that took longest, the time that the card was busy included, microseconds.
    pub slowest_write_us: u32,
}

/// Each written by one task, read by the console.
#[derive(Debug)]
pub struct Checks {
    converter: AtomicU32,
    converter_is_asked: AtomicBool,
    card_blocks: AtomicU32,
    writes: AtomicU32,
    slowest_write_us: AtomicU32,
}

impl Checks {
    pub(super) const fn new() -> Self {
        Self {
            converter: AtomicU32::new(0),
            converter_is_asked: AtomicBool::new(false),
            card_blocks: AtomicU32::new(0),
            writes: AtomicU32::new(0),
            slowest_write_us: AtomicU32::new(0),
        }
    }

    /// Have the task of the converter look at its identity.
    pub fn ask_converter(&self) {
        self.set_converter(ConverterCheck::NotTried);
        self.converter_is_asked.store(true, Relaxed);
    }

    /// See [`ask_converter`](Self::ask_converter).
    pub fn converter_is_asked(&self) -> bool {
        self.converter_is_asked.load(Relaxed)
    }

    /// How the converter is, which answers the question.
    pub fn set_converter(&self, check: ConverterCheck) {
        self.converter.store(check.code(), Relaxed);
        self.converter_is_asked.store(false, Relaxed);
    }

    /// How the converter was when it was last looked at.
    pub fn converter(&self) -> ConverterCheck {
        ConverterCheck::of(self.converter.load(Relaxed))
    }

    /// A card was found, of so many blocks; 0 when it is gone.
    pub fn set_card_blocks(&self, blocks: u32) {
        self.card_blocks.store(blocks, Relaxed);
    }

    /// The card took a write within so many microseconds.
    pub fn card_took(&self, us: u32) {
        self.writes.fetch_add(1, Relaxed);
        self.slowest_write_us.fetch_max(us, Relaxed);
    }

    /// What the card has shown.
    pub fn card(&self) -> CardCheck {
        CardCheck {
            blocks: self.card_blocks.load(Relaxed),
            writes: self.writes.load(Relaxed),
            slowest_write_us: self.slowest_write_us.load(Relaxed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_arrives() {
        let checks = Checks::new();
        assert_eq!(checks.converter(), ConverterCheck::NotTried);
        for check in [
            ConverterCheck::Passed { id: 0x2401 },
            ConverterCheck::NoAnswer { response: 0xFFFF },
            ConverterCheck::OtherChip { id: 0x2200 },
            ConverterCheck::Damaged,
            ConverterCheck::Refuses,
            ConverterCheck::Bus,
        ] {
            checks.ask_converter();
            assert!(checks.converter_is_asked() && checks.converter() == ConverterCheck::NotTried);
            checks.set_converter(check);
            assert!(!checks.converter_is_asked() && checks.converter() == check);
        }
        checks.set_card_blocks(2_000);
        [70, 900, 80].iter().for_each(|&us| checks.card_took(us));
        assert_eq!(checks.card(), CardCheck { blocks: 2_000, writes: 3, slowest_write_us: 900 });
    }
}
