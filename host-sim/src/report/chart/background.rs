//! A reading less all that is slow in it, for the eye: targets are small beside geology and the day.

use crate::collect::{Bin, Envelope};

/// What changes slower than this is background, s; the survey takes the same.
const SLOW_S: f64 = 100.0;
/// Standard deviations from the middle beyond which a value is cut off at first: a target of that size is seen anyway, and
/// one of a tenth of it is seen only then.
const SPREADS: f64 = 30.0;
/// Time between two values of the background, s.
const KNOT_S: f64 = 10.0;

/// `envelope` less its background: the median over 100 s around, which a target of some seconds does not move.
pub(super) fn less_background(envelope: &Envelope) -> Envelope {
    let knots = knots(envelope);
    let less = |bin: &Bin| {
        let (low, high) = (background(&knots, bin.min_at_s), background(&knots, bin.max_at_s));
        Bin { min: bin.min - low, max: bin.max - high, mean: bin.mean - background(&knots, bin.time_s), ..*bin }
    };
    Envelope { bin_width_s: envelope.bin_width_s, bins: envelope.bins.iter().map(less).collect() }
}

/// Time and median of the bins around. In a gap there is none.
fn knots(envelope: &Envelope) -> Vec<(f64, f64)> {
    let bins = &envelope.bins;
    let (Some(first), Some(last)) = (bins.first(), bins.last()) else { return Vec::new() };
    let step_s = KNOT_S.max(envelope.bin_width_s);
    let count = ((last.time_s - first.time_s) / step_s) as usize + 2;
    let at = |k: usize| first.time_s + step_s * k as f64;
    (0..count).filter_map(|k| Some((at(k), median_around(bins, at(k))?))).collect()
}

fn median_around(bins: &[Bin], time_s: f64) -> Option<f64> {
    let from = bins.partition_point(|bin| bin.time_s < time_s - 0.5 * SLOW_S);
    let to = bins.partition_point(|bin| bin.time_s <= time_s + 0.5 * SLOW_S);
    let mut means: Vec<f64> = bins[from..to].iter().map(|bin| bin.mean).collect();
    let middle = means.len().checked_sub(1)? / 2;
    Some(*means.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Linear between knots.
fn background(knots: &[(f64, f64)], time_s: f64) -> f64 {
    let after = knots.partition_point(|knot| knot.0 < time_s).clamp(1, knots.len().max(2) - 1);
    match (knots.get(after - 1), knots.get(after)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * ((time_s - a.0) / (b.0 - a.0)).clamp(0.0, 1.0),
        (Some(only), None) | (None, Some(only)) => only.1,
        (None, None) => 0.0,
    }
}

/// What to show of `envelope` to begin with: all of it from `from_s` on, but for what is [`SPREADS`] away from the middle.
/// `None` without a bin.
pub(super) fn shown_range(envelope: &Envelope, from_s: f64) -> Option<(f64, f64)> {
    let late = || envelope.bins.iter().filter(|bin| bin.time_s >= from_s);
    let mut means: Vec<f64> = late().map(|bin| bin.mean).collect();
    let last = means.len().checked_sub(1)?;
    means.sort_by(f64::total_cmp);
    let at = |share: f64| means[(share * last as f64).round() as usize];
    let (middle, spread) = (at(0.5), 0.5 * (at(0.84) - at(0.16)));
    let low = late().map(|bin| bin.min).fold(f64::INFINITY, f64::min).max(middle - SPREADS * spread);
    let high = late().map(|bin| bin.max).fold(f64::NEG_INFINITY, f64::max).min(middle + SPREADS * spread);
    let margin = 0.05 * (high - low);
    Some((low - margin, high + margin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collect::EnvelopeCollector;

    fn of(nt: impl Fn(f64) -> f64, seconds: u32) -> Envelope {
        let mut collector = EnvelopeCollector::default();
        (0..10 * seconds).map(|i| 0.1 * f64::from(i)).for_each(|time_s| collector.push(time_s, nt(time_s)));
        collector.envelope()
    }

    #[test]
    fn target_stays_and_slope_goes() {
        let target = |time_s: f64| 6.0 * (-((time_s - 300.0) / 1.5).powi(2)).exp();
        let flat = less_background(&of(|time_s| 49_000.0 + 0.05 * time_s + target(time_s), 900));
        let (low, high) = flat.range().unwrap();
        assert!((5.6..6.2).contains(&high) && low > -2.6, "{low} to {high}");
        let inner: Vec<&Bin> = flat.bins.iter().filter(|bin| (100.0..280.0).contains(&bin.time_s)).collect();
        assert!(inner.iter().all(|bin| bin.max.abs() < 0.2), "a slope of the background is left");
    }

    #[test]
    fn range_leaves_a_bad_start_out_and_a_target_in() {
        let wave = |time_s: f64| match time_s {
            t if t < 5.0 => 900.0,
            t if (400.0..402.0).contains(&t) => 6.0,
            t if (500.0..500.5).contains(&t) => -4_000.0,
            t => 0.5 * t.sin(),
        };
        let (low, high) = shown_range(&of(wave, 900), 120.0).unwrap();
        assert!((6.0..8.0).contains(&high) && (-20.0..-8.0).contains(&low), "{low} to {high}");
        assert_eq!(shown_range(&Envelope::default(), 0.0), None);
    }
}
