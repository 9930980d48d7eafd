//! A share that was counted.

use serde::Serialize;

/// Standard deviations of a normal distribution that hold 95 % of it.
const Z: f64 = 1.96;

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
    pub(crate) fn count<T>(all: &[T], is_hit: impl Fn(&T) -> bool) -> Self {
        Self::new(all.iter().filter(|one| is_hit(one)).count(), all.len())
    }

    /// All of them together.
    pub(crate) fn total<'a>(of: impl IntoIterator<Item = &'a Self>) -> Self {
        let (mut hits, mut all) = (0, 0);
        of.into_iter().for_each(|rate| (hits, all) = (hits + rate.hits, all + rate.of));
        Self::new(hits, all)
    }

    /// The share itself; none of none.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.hits as f64 / self.of as f64)
    }
}

/// Wilson's 95 % interval of a share of `of` (Wilson 1927, without correction for continuity).
fn wilson(share: f64, of: f64) -> [f64; 2] {
    let z2 = Z * Z;
    let middle = share + 0.5 * z2 / of;
    let half = Z * (share * (1.0 - share) / of + 0.25 * z2 / (of * of)).sqrt();
    let [low, high] = [middle - half, middle + half].map(|end| end / (1.0 + z2 / of));
    // Of all or none it ends at the share, but for rounding.
    [low.max(0.0).min(share), high.min(1.0).max(share)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_newcombe() {
        // Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3.
        let published = [
            (81, 263, [0.2553, 0.3662]),
            (15, 148, [0.0624, 0.1605]),
            (0, 20, [0.0, 0.1611]),
            (1, 29, [0.0061, 0.1718]),
        ];
        for (hits, of, [low, high]) in published {
            let [from, to] = Rate::new(hits, of).ci95;
            assert!((from - low).abs() < 6e-5 && (to - high).abs() < 6e-5, "{hits} of {of}: {from} {to}");
        }
        for of in 1..4_000 {
            assert_eq!((Rate::new(0, of).ci95[0], Rate::new(of, of).ci95[1]), (0.0, 1.0));
        }
        assert_eq!(Rate::total([&Rate::new(1, 20), &Rate::new(3, 5)]), Rate::new(4, 25));
        assert_eq!(Rate::new(0, 0), Rate { hits: 0, of: 0, ci95: [0.0, 1.0] });
    }
}
