//! Whether anything is left that is no noise, whatever it is: tests that know no effect.

use nalgebra::DVector;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::diagnosis::noise::model::variance_cv_of;
use crate::diagnosis::policy::{NOISE_DENSITY_RATIO, VARIANCE_MODEL_ERROR};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::{dot, explained, gram_of};
use crate::diagnosis::search::log_tail;
use crate::diagnosis::selection::Selection;

/// Lengths of bursts that are looked for, samples.
const BURSTS: [usize; 7] = [1, 3, 10, 30, 100, 300, 1000];
/// Widths of spectral lines that are looked for, in steps of the transform.
const LINES: [usize; 6] = [1, 3, 10, 30, 100, 300];
/// What the noise model may be off by, of its variance: less is no finding.
const TOLERANCE: f64 = 0.12;
/// The same of a short recording: so much more, over the root of its samples.
const TOLERANCE_SAMPLES: f64 = 4.0;

/// Coefficient of a smooth function of the direction that is large, nT.
const LARGEST_NT: f64 = 100.0;

/// What the noise model may be off by, with so many samples to make it from.
fn tolerance(samples: usize) -> f64 {
    TOLERANCE + TOLERANCE_SAMPLES / (samples.max(1) as f64).sqrt()
}

/// A finding of one of the tests.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) what: &'static str,
    /// Logarithm of its chance under noise, all tries of the test counted.
    pub(crate) log_p: f64,
    /// Whitened power that it is about, over what noise has.
    pub(crate) excess: f64,
}

/// All tests on what the search of a channel leaves.
pub(crate) fn findings(selection: &Selection<'_>) -> Vec<Finding> {
    let Selection { problem, fit, variance, noise, .. } = selection;
    let variance_cv = &noise.variance_cv();
    let z: Vec<f64> = fit.residual_whitened.iter().map(|z| z / variance.sqrt()).collect();
    let there: Vec<f64> = problem.whitening.observed(&z).collect();
    // White noise in some of the samples is not white any more once all are whitened alike.
    let variances: Vec<f64> = problem.whitening.weights().iter().map(|weight| 1.0 / (weight * weight)).collect();
    // As in the search: where the noise of the direction is let through it is that much denser.
    let gathered = variance * (1.0 + NOISE_DENSITY_RATIO * variance_cv);
    vec![
        bursts(&z, *variance_cv),
        lines(&z, variance_cv_of(&variances)),
        slow_variance(&z, *variance_cv),
        impulses(&there, *variance_cv),
        attitude(problem, fit, gathered),
        memory(problem, fit, gathered),
    ]
}

/// Variance that is larger for a while.
fn bursts(z: &[f64], variance_cv: f64) -> Finding {
    let mut running = vec![0.0; z.len() + 1];
    for (k, z) in z.iter().enumerate() {
        running[k + 1] = running[k] + z * z;
    }
    let mut best = Finding { what: "bursts", log_p: 0.0, excess: 0.0 };
    for length in BURSTS.into_iter().filter(|&length| 4 * length <= z.len()) {
        let count = length as f64;
        let sum = (0..=z.len() - length).map(|k| running[k + length] - running[k]).fold(0.0, f64::max);
        let tries = z.len() as f64 / count * 3.0 * BURSTS.len() as f64;
        let log_p = log_tail(count, sum / (1.0 + tolerance(z.len()) + VARIANCE_MODEL_ERROR * variance_cv)) + tries.ln();
        if log_p < best.log_p {
            best = Finding { log_p, excess: sum - count, ..best };
        }
    }
    // All of the excess of what is burst-like, not of the largest alone.
    best.excess = best.excess.max(z.iter().map(|z| (z * z - 12.0).max(0.0)).sum());
    best
}

/// Power that is gathered in a part of the spectrum.
fn lines(z: &[f64], variance_cv: f64) -> Finding {
    let n = z.len();
    let mut spectrum: Vec<Complex<f64>> = z.iter().map(|z| Complex::new(*z, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(n).process(&mut spectrum);
    let powers: Vec<f64> = spectrum[..n / 2].iter().map(|value| value.norm_sqr() / n as f64).collect();
    let first = (0.04 / 10.0 * n as f64) as usize;
    let mut running = vec![0.0; powers.len() + 1];
    for (k, power) in powers.iter().enumerate() {
        running[k + 1] = running[k] + power;
    }
    let mut best = Finding { what: "lines", log_p: 0.0, excess: 0.0 };
    for width in LINES.into_iter().filter(|&width| first + 4 * width <= powers.len()) {
        let count = width as f64;
        let sum = (first..=powers.len() - width).map(|k| running[k + width] - running[k]).fold(0.0, f64::max);
        let tries = powers.len() as f64 / count * 3.0 * LINES.len() as f64;
        // The wider the part, the more the noise model itself may be off.
        let allowed = 1.0 + 2.0 * tolerance(n) + NOISE_DENSITY_RATIO * variance_cv;
        let log_p = log_tail(2.0 * count, 2.0 * sum / allowed) + tries.ln();
        if log_p < best.log_p {
            best = Finding { log_p, excess: 2.0 * (sum - count), ..best };
        }
    }
    best
}

/// Noise whose size wanders: autocorrelation of the squares over seconds to minutes.
fn slow_variance(z: &[f64], variance_cv: f64) -> Finding {
    let length = 50;
    let sums: Vec<f64> = z
        .chunks_exact(length)
        .map(|part| part.iter().map(|z| (z * z).min(16.0)).sum::<f64>() / length as f64)
        .collect();
    let n = sums.len() as f64;
    if n < 8.0 {
        return Finding { what: "variance", log_p: 0.0, excess: 0.0 };
    }
    let mean = sums.iter().sum::<f64>() / n;
    let relative = 2.0 / length as f64 * mean * mean * 1.1;
    let chi = sums.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>()
        / (relative + ((0.5 * tolerance(z.len()) + 0.5 * VARIANCE_MODEL_ERROR * variance_cv) * mean).powi(2));
    let excess = sums.iter().map(|sum| (sum - mean).abs()).sum::<f64>() * length as f64 * 0.5;
    Finding { what: "variance", log_p: log_tail(n - 1.0, chi), excess }
}

/// Samples that are large more often than those of noise: what switches or knocks leaves them, however its spectrum looks.
fn impulses(z: &[f64], variance_cv: f64) -> Finding {
    let n = z.len() as f64;
    let mean_square = dot(z, z) / n;
    let kurtosis = z.iter().map(|z| z.powi(4)).sum::<f64>() / n / (mean_square * mean_square);
    // Noise whose variance differs by so much more than was thought has the more of them.
    let allowed = 1.0 + (0.5 * VARIANCE_MODEL_ERROR * variance_cv).powi(2);
    let score = if kurtosis > 3.0 * allowed { kurtosis_score(kurtosis / allowed, n) } else { 0.0 };
    let excess = z.iter().map(|z| (z * z / mean_square - 9.0).max(0.0)).sum();
    Finding { what: "impulses", log_p: log_tail(1.0, score * score), excess }
}

/// Standard normal, as near as can be, for the kurtosis of `n` normal samples (Anscombe and Glynn, Biometrika 70, 1983,
/// p. 227).
fn kurtosis_score(kurtosis: f64, n: f64) -> f64 {
    let mean = 3.0 * (n - 1.0) / (n + 1.0);
    let variance = 24.0 * n * (n - 2.0) * (n - 3.0) / ((n + 1.0).powi(2) * (n + 3.0) * (n + 5.0));
    let x = (kurtosis - mean) / variance.sqrt();
    let skewness = 6.0 * (n * n - 5.0 * n + 2.0) / ((n + 7.0) * (n + 9.0))
        * (6.0 * (n + 3.0) * (n + 5.0) / (n * (n - 2.0) * (n - 3.0))).sqrt();
    let a = 6.0 + 8.0 / skewness * (2.0 / skewness + (1.0 + 4.0 / (skewness * skewness)).sqrt());
    let root = ((1.0 - 2.0 / a) / (1.0 + x * (2.0 / (a - 4.0)).sqrt())).cbrt();
    (1.0 - 2.0 / (9.0 * a) - root) / (2.0 / (9.0 * a)).sqrt()
}

/// Anything smooth in the direction, and a permanent magnetisation that wanders.
fn attitude(problem: &RegressionProblem<'_>, fit: &Fit, variance: f64) -> Finding {
    let direction = &problem.signals.rows().direction;
    let duration_s = problem.duration_s();
    let mut raw = crate::diagnosis::search::monomials(direction);
    for degree in 1..=6 {
        for i in 0..3 {
            let phase =
                |row: usize| std::f64::consts::PI * f64::from(degree) * problem.signals.epochs_s()[row] / duration_s;
            raw.push((0..direction.len()).map(|row| direction[row][i] * phase(row).cos()).collect());
        }
    }
    of_columns("attitude", problem, fit, variance, &raw)
}

/// What remembers earlier attitudes: low-passes of the direction, and the sense in which it changes.
fn memory(problem: &RegressionProblem<'_>, fit: &Fit, variance: f64) -> Finding {
    let direction = &problem.signals.rows().direction;
    let rate = &problem.signals.rows().direction_rate;
    let mut raw = Vec::new();
    for i in 0..3 {
        for keep in [0.9, 0.97] {
            let mut state = direction[0][i];
            raw.push(
                direction
                    .iter()
                    .map(|c| {
                        state = keep * state + (1.0 - keep) * c[i];
                        state
                    })
                    .collect(),
            );
        }
        raw.push(rate.iter().map(|r| (r[i] / 0.02).tanh()).collect());
        for j in 0..3 {
            raw.push(rate.iter().zip(direction).map(|(r, c)| (r[i] / 0.05).tanh() * c[j]).collect());
        }
    }
    of_columns("memory", problem, fit, variance, &raw)
}

fn of_columns(
    what: &'static str,
    problem: &RegressionProblem<'_>,
    fit: &Fit,
    variance: f64,
    raw: &[Vec<f64>],
) -> Finding {
    let mut projected = problem.projected(raw, &fit.projection);
    // A column that would not show with a coefficient of 100 nT is the noise of the direction.
    projected.retain(|column| dot(column, column) * LARGEST_NT * LARGEST_NT > 1.0);
    if projected.is_empty() {
        return Finding { what, log_p: 0.0, excess: 0.0 };
    }
    let gram = gram_of(&projected.iter().map(|column| &column[..]).collect::<Vec<_>>());
    let q = DVector::from_iterator(projected.len(), projected.iter().map(|column| dot(column, &fit.residual_whitened)));
    let (glrt, _, rank) = explained(&gram, &q);
    let glrt = glrt / variance;
    Finding {
        what,
        log_p: log_tail(rank as f64, glrt / (1.0 + tolerance(fit.residual_whitened.len()))),
        excess: glrt - rank as f64,
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn the_score_of_a_kurtosis_is_the_published_one() {
        // SciPy's kurtosistest, which is the same transformation.
        for (kurtosis, n, score) in [(3.0, 6000.0, 0.047285), (3.4, 6000.0, 5.356133), (2.8, 1000.0, -1.333778)] {
            assert!((kurtosis_score(kurtosis, n) - score).abs() < 1e-4, "{kurtosis}: {}", kurtosis_score(kurtosis, n));
        }
    }

    #[test]
    fn a_current_that_switches_now_and_then_leaves_impulses_and_noise_leaves_none() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let mut z: Vec<f64> = (0..6000).map(|_| StandardNormal.sample(&mut random)).collect();
        assert!(impulses(&z, 0.0).log_p > -5.0);
        z.iter_mut().step_by(60).for_each(|z| *z += 4.0);
        assert!(impulses(&z, 0.0).log_p < -20.0, "{}", impulses(&z, 0.0).log_p);
        // Where the direction's noise may be misjudged by as much, that proves nothing.
        assert!(impulses(&z, 0.5).log_p > -5.0);
    }

    #[test]
    fn long_stretches_of_noise_are_no_burst() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        let z: Vec<f64> = (0..12_000).map(|_| StandardNormal.sample(&mut random)).collect();
        for variance_cv in [0.0, 0.2, 0.5] {
            assert!(bursts(&z, variance_cv).log_p > -5.0);
            assert!(lines(&z, variance_cv).log_p > -5.0);
            assert!(slow_variance(&z, variance_cv).log_p > -5.0);
        }
    }
}
