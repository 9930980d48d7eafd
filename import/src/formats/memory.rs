//! How much memory a reader may take for a file.

use super::format::LARGEST_GROWTH;

/// Always allowed, however short the file is.
const FLOOR_BYTES: usize = 16_000_000;

/// Memory that a reader has left to take. What a damaged file claims of its sizes is held against it before it is made.
#[derive(Clone, Debug)]
pub(super) struct Budget {
    allowed: usize,
    left: usize,
}

/// The file claims more than its length warrants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "what it holds is larger than the {allowed} bytes that a file of its length may need: it is damaged, or made to do harm"
)]
pub(super) struct TooLarge {
    allowed: usize,
}

impl Budget {
    /// Of a file of so many bytes.
    pub(super) fn of(file_bytes: usize) -> Self {
        let allowed = file_bytes.saturating_mul(LARGEST_GROWTH).max(FLOOR_BYTES);
        Self { allowed, left: allowed }
    }

    /// Takes `count` things of `size` bytes.
    pub(super) fn take(&mut self, count: usize, size: usize) -> Result<(), TooLarge> {
        let refused = TooLarge { allowed: self.allowed };
        self.left = count.checked_mul(size).and_then(|bytes| self.left.checked_sub(bytes)).ok_or(refused)?;
        Ok(())
    }

    /// What is left, in bytes.
    pub(super) fn left(&self) -> usize {
        self.left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_beyond_the_file_is_refused_even_where_its_size_overflows() {
        let mut budget = Budget::of(1_000_000);
        assert!(budget.take(5_000_000, 8).is_ok());
        assert_eq!(budget.left(), 0);
        assert_eq!(budget.take(1, 1), Err(TooLarge { allowed: 40_000_000 }));
        assert!(Budget::of(10).take(usize::MAX, 8).is_err());
        assert!(Budget::of(10).take(2_000_000, 8).is_ok());
    }
}
