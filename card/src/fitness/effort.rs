//! How long a trial takes, and how much of the card it sees.

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Bytes in one piece that are filled, and written again for pauses and speed.
    pub(super) dense_bytes: u64,
    /// Of the rest of a card, a block is tried in each piece of this size.
    pub(super) stride_bytes: u64,
    /// Of a folder at most so much is filled.
    pub(super) most_bytes: u64,
    /// Sectors that are written one a second.
    pub(super) slow_writes: usize,
    /// Sectors that are written one after the other.
    pub(super) burst_writes: usize,
}

impl Effort {
    /// A minute.
    pub const QUICK: Self = Self {
        dense_bytes: 16 << 20,
        stride_bytes: 16 << 20,
        most_bytes: 256 << 20,
        slow_writes: 20,
        burst_writes: 200,
    };

    /// What a card should be put through before it goes to sea.
    pub const THOROUGH: Self = Self {
        dense_bytes: 64 << 20,
        stride_bytes: 4 << 20,
        most_bytes: u64::MAX,
        slow_writes: 120,
        burst_writes: 2_000,
    };
}
