//! A series continued beyond its ends, by linear prediction.

use crate::diagnosis::numerics::levinson_step;

/// Rows beyond each end that are predicted from those before it.
const PREDICTED_ROWS: usize = 100;
/// Rows that a prediction is made from at most, and its order at most.
const LEARNT_ROWS: usize = 500;
const ORDER: usize = 40;

/// The [`PREDICTED_ROWS`] values after a series, by linear prediction about its mean: a body that rocks goes on rocking.
pub(crate) fn predicted(values: &[f64]) -> Vec<f64> {
    let known = &values[values.len().saturating_sub(LEARNT_ROWS)..];
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let mut all: Vec<f64> = known.iter().map(|value| value - mean).collect();
    let weights = burg(&all, ORDER.min(all.len() / 4));
    for _ in 0..PREDICTED_ROWS {
        let next = weights.iter().zip(all.iter().rev()).map(|(w, x)| w * x).sum();
        all.push(next);
    }
    all[known.len()..].iter().map(|value| value + mean).collect()
}

/// Weights of the values before, the latest first: Burg's recursion, whose predictions never grow (Burg, "Maximum
/// entropy spectral analysis", 1967).
fn burg(values: &[f64], order: usize) -> Vec<f64> {
    let (mut forward, mut backward) = (values.to_vec(), values.to_vec());
    let mut weights: Vec<f64> = Vec::new();
    for k in 0..order {
        let pairs = || forward[k + 1..].iter().zip(&backward[k..]);
        let power: f64 = pairs().map(|(f, b)| f * f + b * b).sum();
        if power <= 0.0 {
            break;
        }
        let reflection = 2.0 * pairs().map(|(f, b)| f * b).sum::<f64>() / power;
        levinson_step(&mut weights, reflection);
        for n in (k + 1..values.len()).rev() {
            let (f, b) = (forward[n], backward[n - 1]);
            forward[n] = f - reflection * b;
            backward[n] = b - reflection * f;
        }
    }
    weights
}
