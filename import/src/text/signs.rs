//! What parts the fields of a text, and what stands before its decimals.

/// What parts the fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delimiter {
    /// One byte.
    Byte(u8),
    /// Blanks and tabs, any number of them.
    Blanks,
}

/// What stands before the decimals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decimal {
    /// `51384.25`
    Point,
    /// `51384,25`
    Comma,
}

impl Delimiter {
    /// For the user and for profiles.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Byte(b',') => "comma",
            Self::Byte(b';') => "semicolon",
            Self::Byte(b'\t') => "tab",
            Self::Byte(_) => "bar",
            Self::Blanks => "blanks",
        }
    }

    /// The candidates, the likelier first.
    pub(crate) const ALL: [Self; 5] =
        [Self::Byte(b','), Self::Byte(b';'), Self::Byte(b'\t'), Self::Byte(b'|'), Self::Blanks];

    /// By [`Self::name`].
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|delimiter| delimiter.name() == name)
    }
}

impl Decimal {
    /// For the user and for profiles.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Comma => "comma",
        }
    }

    /// By [`Self::name`].
    pub(crate) fn named(name: &str) -> Option<Self> {
        [Self::Point, Self::Comma].into_iter().find(|decimal| decimal.name() == name)
    }
}
