//! A share that was counted.

use serde::Serialize;

use crate::diagnosis::wilson;

/// A share, with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// How many of them.
    pub hits: usize,
    /// How many there were.
    pub of: usize,
    /// Wilson's 95 % interval of the share; 0 to 1 where there were none.
    pub ci95: [f64; 2],
}

impl Rate {
    /// `hits` of `of`.
    pub fn new(hits: usize, of: usize) -> Self {
        let ci95 = if of == 0 { [0.0, 1.0] } else { wilson(hits as f64 / of as f64, of as f64) };
        Self { hits, of, ci95 }
    }

    /// Those of `all` that are one.
    pub(in crate::trial) fn count<T>(all: &[T], is_hit: impl Fn(&T) -> bool) -> Self {
        Self::new(all.iter().filter(|one| is_hit(one)).count(), all.len())
    }

    /// The share itself; none of none.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.hits as f64 / self.of as f64)
    }
}
