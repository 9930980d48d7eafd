//! Elements of a MATLAB file: a type, a length, and so many bytes.

use std::io::Read as _;

use super::super::memory::{Budget, TooLarge};

/// Order of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    #[error("is cut or damaged in {0}: copy it again from where it was made")]
    Cut(&'static str),
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
}

/// Kinds of elements (table 1 of the format).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
    I64,
    U64,
    Matrix,
    Compressed,
    Utf8,
    Utf16,
    Utf32,
}

/// An element of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<'a> {
    pub(super) kind: Kind,
    pub(super) bytes: &'a [u8],
}

/// What is left to read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elements<'a> {
    rest: &'a [u8],
    order: Order,
}

impl Order {
    fn number<const N: usize>(self, bytes: &[u8]) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = bytes.try_into().ok()?;
        if self == Self::Big {
            bytes.reverse();
        }
        Some(bytes)
    }

    fn u32(self, bytes: &[u8]) -> Option<u32> {
        self.number(bytes).map(u32::from_le_bytes)
    }
}

impl<'a> Elements<'a> {
    pub(super) fn new(rest: &'a [u8], order: Order) -> Self {
        Self { rest, order }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next one; `what` it is expected to be, for messages.
    pub(super) fn next(&mut self, what: &'static str) -> Result<Element<'a>, Fault> {
        self.take().ok_or(Fault::Cut(what))
    }

    fn take(&mut self) -> Option<Element<'a>> {
        let first = self.order.u32(self.rest.get(..4)?)?;
        let (kind, start, length) = match first >> 16 {
            0 => (first, 8_usize, self.order.u32(self.rest.get(4..8)?)? as usize),
            // Up to four bytes stand in the tag itself.
            length => (first & 0xffff, 4, Some(length as usize).filter(|length| *length <= 4)?),
        };
        let kind = Kind::of(kind)?;
        let bytes = self.rest.get(start..start.checked_add(length)?)?;
        let whole = if start == 4 { 8 } else { start + length };
        // All but the compressed ones are filled up to eight bytes; the last one's filling may be lacking.
        let filled = if kind == Kind::Compressed { whole } else { whole.next_multiple_of(8) };
        self.rest = self.rest.get(filled..).unwrap_or_default();
        Some(Element { kind, bytes })
    }
}

impl Kind {
    fn of(number: u32) -> Option<Self> {
        Some(match number {
            1 => Self::I8,
            2 => Self::U8,
            3 => Self::I16,
            4 => Self::U16,
            5 => Self::I32,
            6 => Self::U32,
            7 => Self::F32,
            9 => Self::F64,
            12 => Self::I64,
            13 => Self::U64,
            14 => Self::Matrix,
            15 => Self::Compressed,
            16 => Self::Utf8,
            17 => Self::Utf16,
            18 => Self::Utf32,
            _ => return None,
        })
    }
}

impl Element<'_> {
    /// Its numbers, whatever they are stored as.
    pub(super) fn numbers(&self, order: Order, budget: &mut Budget) -> Result<Vec<f64>, Fault> {
        fn each<const N: usize>(bytes: &[u8], order: Order, number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
            bytes.chunks_exact(N).filter_map(|bytes| order.number(bytes)).map(number).collect()
        }
        let widest = if matches!(self.kind, Kind::I8 | Kind::U8 | Kind::Utf8) { 8 } else { 4 };
        budget.take(self.bytes.len(), widest)?;
        Ok(match self.kind {
            Kind::I8 => each(self.bytes, order, |bytes| i8::from_le_bytes(bytes).into()),
            Kind::U8 | Kind::Utf8 => each(self.bytes, order, |bytes| u8::from_le_bytes(bytes).into()),
            Kind::I16 => each(self.bytes, order, |bytes| i16::from_le_bytes(bytes).into()),
            Kind::U16 | Kind::Utf16 => each(self.bytes, order, |bytes| u16::from_le_bytes(bytes).into()),
            Kind::I32 => each(self.bytes, order, |bytes| i32::from_le_bytes(bytes).into()),
            Kind::U32 | Kind::Utf32 => each(self.bytes, order, |bytes| u32::from_le_bytes(bytes).into()),
            Kind::F32 => each(self.bytes, order, |bytes| f32::from_le_bytes(bytes).into()),
            Kind::F64 => each(self.bytes, order, f64::from_le_bytes),
            Kind::I64 => each(self.bytes, order, |bytes| i64::from_le_bytes(bytes) as f64),
            Kind::U64 => each(self.bytes, order, |bytes| u64::from_le_bytes(bytes) as f64),
            Kind::Matrix | Kind::Compressed => return Err(Fault::Cut("its numbers")),
        })
    }

    /// What a compressed element holds.
    pub(super) fn inflated(&self, budget: &mut Budget) -> Result<Vec<u8>, Fault> {
        let mut bytes = Vec::new();
        let mut limited = flate2::read::ZlibDecoder::new(self.bytes).take(budget.left() as u64 + 1);
        limited.read_to_end(&mut bytes).map_err(|_| Fault::Cut("a compressed variable"))?;
        budget.take(bytes.len(), 1)?;
        Ok(bytes)
    }
}
