//! The information that a session started from, in parts that fit a record.

use crate::bytes::{Put, Take};
use crate::estimate::{Information, TRIANGLE};
use crate::model::TERMS;
use crate::wire::{put_information, take_information};

/// Bytes of all of it.
const LEN: usize = 4 * (TERMS + TRIANGLE + 1);

/// Parts that it takes.
const PARTS: usize = 5;

/// Bytes of a part: 38 numbers.
const PART_LEN: usize = LEN / PARTS;

/// One of the five parts of an [`Information`], which follow the header of a session, in order.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct InformationPart {
    /// Which, from 0.
    part: u8,
    /// Its share of `solution 18 x f32, triangle 171 x f32, noise_nt f32`.
    bytes: [u8; PART_LEN],
}

impl core::fmt::Debug for InformationPart {
    /// Without the bytes: they say nothing to whoever reads events.
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} of {PARTS}", self.part + 1)
    }
}

impl InformationPart {
    /// All parts.
    pub fn all(information: &Information) -> impl Iterator<Item = Self> {
        let mut all = [[0; PART_LEN]; PARTS];
        put_information(information, &mut Put::new(all.as_flattened_mut()));
        (0_u8..).zip(all).map(|(part, bytes)| Self { part, bytes })
    }

    pub(super) fn put(&self, put: &mut Put<'_>) {
        put.u8(self.part);
        put.bytes(&self.bytes);
    }

    pub(super) fn take(take: &mut Take<'_>) -> Option<Self> {
        let part = take.u8().filter(|&part| usize::from(part) < PARTS)?;
        Some(Self { part, bytes: take.array()? })
    }
}

/// The parts that have been read.
#[derive(Clone, Copy, Debug)]
pub struct InformationParts {
    bytes: [[u8; PART_LEN]; PARTS],
    is_there: [bool; PARTS],
}

impl Default for InformationParts {
    fn default() -> Self {
        Self { bytes: [[0; PART_LEN]; PARTS], is_there: [false; PARTS] }
    }
}

impl InformationParts {
    /// One more.
    pub fn add(&mut self, part: &InformationPart) {
        let place = usize::from(part.part);
        if let (Some(bytes), Some(is_there)) = (self.bytes.get_mut(place), self.is_there.get_mut(place)) {
            (*bytes, *is_there) = (part.bytes, true);
        }
    }

    /// The whole, when all parts are there.
    pub fn information(&self) -> Option<Information> {
        let complete = self.is_there.iter().all(|&is_there| is_there);
        if complete { take_information(&mut Take(self.bytes.as_flattened())) } else { None }
    }
}
