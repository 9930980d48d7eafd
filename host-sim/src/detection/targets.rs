//! The anomalies that are added.

use crate::simulator::Target;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Range of the peaks, nT.
const PEAK_NT: std::ops::Range<f64> = 5.0..15.0;
/// Range of the widths at half the peak, s.
const WIDTH_S: std::ops::Range<f64> = 1.0..2.5;

/// `count` dipole anomalies of either sign, one somewhere in each of `count` equal parts of the time from `first_s` to
/// `last_s`, away from the parts' ends. The same seed gives the same ones.
pub fn injected_targets(count: usize, (first_s, last_s): (f64, f64), seed: u64) -> Vec<Target> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let part_s = (last_s - first_s) / count as f64;
    (0..count)
        .map(|part| {
            let sign = if random.random_bool(0.5) { 1.0 } else { -1.0 };
            Target {
                time_s: first_s + part_s * (part as f64 + random.random_range(0.15..0.85)),
                peak_nt: sign * random.random_range(PEAK_NT),
                width_s: random.random_range(WIDTH_S),
            }
        })
        .collect()
}
