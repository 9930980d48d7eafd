//! Whether what a base station tells is in the recording too.

use crate::result::Estimate;

/// The field is compared in means of so many rows: what is quicker was smoothed away at the base station.
const BLOCK_ROWS: usize = 100;
/// Fewer steps from mean to mean tell nothing.
const LEAST_STEPS: usize = 20;
/// A 95 % interval reaches so many standard deviations to either side.
const INTERVAL_STD: f64 = 1.96;

/// The share of the base station's changes that the field of a recording shows: 1 where they are all there, 0 where there are
/// none of them. `field_nt` is the field with the change with the day still in it. `None` where nothing can be said.
///
/// The steps from mean to mean are compared: over ground the field wanders, and its steps are independent of each other where it
/// does so as a random walk. The interval is that of White (1980), which asks for no even noise.
pub(crate) fn share(field_nt: &[f64], variation_nt: &[f64]) -> Option<Estimate> {
    let (field, variation) = (steps(field_nt), steps(variation_nt));
    let pairs = || field.iter().zip(&variation).filter_map(|(f, v)| f.zip(*v));
    let power: f64 = pairs().map(|(_, v)| v * v).sum();
    if power <= 0.0 || pairs().count() < LEAST_STEPS {
        return None;
    }
    let value = pairs().map(|(f, v)| f * v).sum::<f64>() / power;
    let std = pairs().map(|(f, v)| (v * (f - value * v)).powi(2)).sum::<f64>().sqrt() / power;
    Some(Estimate { value, low: value - INTERVAL_STD * std, high: value + INTERVAL_STD * std })
}

/// From the mean of each block to that of the next, where both are there.
fn steps(values: &[f64]) -> Vec<Option<f64>> {
    let mean = |block: &[f64]| {
        let known = block.iter().filter(|value| value.is_finite());
        let count = known.clone().count();
        (2 * count >= BLOCK_ROWS).then(|| known.sum::<f64>() / count as f64)
    };
    let means: Vec<Option<f64>> = values.chunks(BLOCK_ROWS).map(mean).collect();
    means.windows(2).map(|pair| Some(pair[1]? - pair[0]?)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: usize = 12_000;

    /// A wave, nT, of this period in rows.
    fn wave(period: f64, amplitude_nt: f64) -> Vec<f64> {
        (0..ROWS).map(|row| amplitude_nt * (std::f64::consts::TAU * row as f64 / period).sin()).collect()
    }

    fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| 50_000.0 + a + b).collect()
    }

    #[test]
    fn it_is_one_of_the_same_field_and_none_of_another() {
        let (day, rock) = (wave(3_000.0, 5.0), wave(1_770.0, 4.0));
        let same = share(&sum(&day, &rock), &day).unwrap();
        assert!(same.low < 1.0 && 1.0 < same.high && same.low > 0.5, "{same:?}");
        let elsewhere = share(&sum(&rock, &wave(777.0, 1.0)), &day).unwrap();
        assert!(elsewhere.low < 0.0 && 0.0 < elsewhere.high && elsewhere.high < 0.5, "{elsewhere:?}");
        let reversed = share(&sum(&wave(3_000.0, -5.0), &rock), &day).unwrap();
        assert!(reversed.high < -0.5, "{reversed:?}");
    }

    #[test]
    fn of_a_base_station_that_stands_still_nothing_is_said() {
        assert_eq!(share(&wave(3_000.0, 5.0), &vec![0.0; ROWS]), None);
        assert_eq!(share(&[50_000.0; 300], &[0.1; 300]), None);
    }
}
