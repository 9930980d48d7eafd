//! Which colour a stretch of the track has: few classes with round limits, which sunlight does not wash out.

use crate::report::svg::round_step;
use crate::text::number::short;

/// Above this many noise floors an anomaly is shown as one.
const SHOWN: f64 = 5.0;

/// Limits between classes, rising.
pub(super) struct Classes {
    limits: Vec<f64>,
}

impl Classes {
    /// Of anomalies by size, from `noise_floor` to `largest`, nT: round, and about evenly apart in the logarithm.
    pub(super) fn of_anomalies(noise_floor: f64, largest: f64) -> Self {
        let lowest = if noise_floor > 0.0 { SHOWN * noise_floor } else { 0.05 * largest };
        // The last class begins at a third of the largest: it must hold more than one object.
        Self::between(lowest, (largest / 3.0).max(4.0 * lowest))
    }

    /// Of positive values, from the smaller to the larger.
    pub(super) fn between(low: f64, high: f64) -> Self {
        let mut limits: Vec<f64> = [low, (low * high).sqrt(), high].map(round_step).to_vec();
        limits.retain(|limit| limit.is_finite() && *limit > 0.0);
        limits.dedup();
        Self { limits }
    }

    /// How many limits a size is above.
    pub(super) fn of(&self, size: f64) -> usize {
        self.limits.iter().filter(|limit| size > **limit).count()
    }

    /// What each class of a size holds, the smallest first.
    pub(super) fn ranges(&self, unit: &str) -> Vec<String> {
        let (Some(first), Some(last)) = (self.limits.first(), self.limits.last()) else { return Vec::new() };
        let between = |pair: &[f64]| format!("{} to {} {unit}", short(pair[0]), short(pair[1]));
        let mut ranges = vec![format!("up to {} {unit}", short(*first))];
        ranges.extend(self.limits.windows(2).map(between));
        ranges.push(format!("above {} {unit}", short(*last)));
        ranges
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_round_and_each_size_has_one_class() {
        let classes = Classes::of_anomalies(0.02, 40.0);
        assert_eq!(classes.ranges("nT"), ["up to 0.1 nT", "0.1 to 1 nT", "1 to 10 nT", "above 10 nT"]);
        assert_eq!([0.0, 0.1, 0.2, 3.0, 11.0].map(|size| classes.of(size)), [0, 0, 1, 2, 3]);
        assert_eq!(Classes::between(1.0, 1.0).ranges("A m²"), ["up to 1 A m²", "above 1 A m²"]);
        assert_eq!(Classes::between(0.0, 0.0).of(3.0), 0);
    }
}
