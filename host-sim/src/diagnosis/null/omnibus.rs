//! Omnibus tests: whether anything but noise is in a residual, whatever it is. They know no effect.

use super::coherence::coherence;
use super::doubt::Doubt;
use super::finding::Finding;
use super::inputs::inputs;
use super::kurtosis::{impulses, levels};
use super::loudness::loudness;
use super::periodogram::powers;
use super::rhythm::rhythm;
use super::tails::normal_scores;
use crate::diagnosis::noise::model::tolerance;
use crate::diagnosis::noise::motion::{attitude_columns, memory_columns};
use crate::diagnosis::numerics::{cumulative_sums, rms};
use crate::diagnosis::policy::{
    BURSTS_DOUBT, COLUMN_LARGEST_NT, LARGE_SAMPLE_SQUARES, LINES_DOUBT, LINES_LOWEST_HZ, LOUDNESS_DOUBT, RATE_HZ,
    SLOW_VARIANCE_DOUBT, SLOW_VARIANCE_LEAST_PARTS, SLOW_VARIANCE_SPREAD, TOLERANCE_THAT_CHANGES,
    WINDOW_OVERLAP_TRIALS,
};
use crate::diagnosis::reconstruct::direction_noise::DirectionNoise;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::diagnosis::regression::problem::solve;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::search::log_tail;
use crate::diagnosis::selection::Selection;
use crate::diagnosis::shapes::scene::Scene;

/// Lengths of bursts that are looked for, samples.
const BURSTS: [usize; 7] = [1, 3, 10, 30, 100, 300, 1000];
/// Widths of spectral lines that are looked for, in steps of the transform.
const LINES: [usize; 6] = [1, 3, 10, 30, 100, 300];
/// Samples whose mean square is followed over time.
const SLOW_VARIANCE_SAMPLES: usize = 50;
/// Squares count no more than this there: a burst is another test's.
const SLOW_VARIANCE_LARGEST_SQUARE: f64 = 16.0;

/// All tests on the residual of a channel with everything that was named, by what was recorded beside it; with the noise of the
/// fluxgate's direction, where it has no other errors.
pub(crate) fn tests(
    selection: &Selection<'_>,
    direction_noise: Option<&DirectionNoise>,
    table: &Prepared,
) -> Vec<Finding> {
    let Selection { problem, fit, variance, noise, .. } = selection;
    let doubt = Doubt::of(noise);
    let z: Vec<f64> = fit.residual_whitened.iter().map(|z| z / variance.sqrt()).collect();
    // Heavy tails that are there all the time are noise: what comes in bursts, or too often for any tail, is not.
    let even = normal_scores(&z);
    let observed: Vec<f64> = normal_scores(&problem.whitening.observed(&z).collect::<Vec<_>>());
    let at_readings = doubt.observed(problem);
    let changes = tolerance_that_changes(z.len());
    let by_motion: Vec<f64> = doubt.of_samples(LOUDNESS_DOUBT).map(|doubt| changes + doubt).collect();
    vec![
        rhythm(&even, changes),
        loudness(problem, &even, rms(&by_motion)),
        bursts(&even, &doubt),
        lines(&even, noise.whitened_density(), &doubt),
        // Where no reading is, nothing is left.
        slow_variance(&observed, &at_readings),
        impulses(&observed, &at_readings),
        levels(problem.channel, &observed),
        of_columns("attitude", selection, &even, &attitude_columns(&problem.signals)),
        of_columns("memory", selection, &even, &memory_columns(&problem.signals)),
        coherence(problem, &even, direction_noise, noise.of_draws()),
        inputs(problem, fit, &even, &Scene::of(&problem.signals, table)),
    ]
}

/// What the noise model may have wrong of the variance of some of the samples, as a share of it, wherever its noise comes from.
fn tolerance_that_changes(samples: usize) -> f64 {
    TOLERANCE_THAT_CHANGES * tolerance(samples)
}

/// The largest sum over `width` successive values from `first` on, from their cumulative sums.
fn largest_sum(cumulative: &[f64], first: usize, width: usize) -> f64 {
    (first..cumulative.len() - width).map(|k| cumulative[k + width] - cumulative[k]).fold(0.0, f64::max)
}

/// Logarithm of the number of windows of one of `widths` widths that are as good as independent.
fn log_windows(values: usize, width: f64, widths: usize) -> f64 {
    (values as f64 / width * WINDOW_OVERLAP_TRIALS * widths as f64).ln()
}

/// Variance that is larger for a while; `z` is white, of variance 1.
fn bursts(z: &[f64], doubt: &Doubt) -> Finding {
    let cumulative = cumulative_sums(z.iter().map(|z| z * z));
    let known = 1.0 + tolerance(z.len());
    let allowed = cumulative_sums(doubt.of_samples(BURSTS_DOUBT).map(|doubt| known + doubt));
    let mut best = Finding { what: "bursts", log_p: 0.0, excess: 0.0 };
    for length in BURSTS.into_iter().filter(|&length| 4 * length <= z.len()) {
        let count = length as f64;
        let sum = |sums: &[f64], first: usize| sums[first + length] - sums[first];
        let ratio = |first: &usize| sum(&cumulative, *first) / sum(&allowed, *first);
        let windows = 0..cumulative.len() - length;
        let Some(first) = windows.max_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { continue };
        let log_p = log_tail(count, count * ratio(&first)) + log_windows(z.len(), count, BURSTS.len());
        if log_p < best.log_p {
            best = Finding { log_p, excess: sum(&cumulative, first) - count, ..best };
        }
    }
    // All of the excess of what is burst-like, not of the largest alone.
    best.excess = best.excess.max(z.iter().map(|z| (z * z - LARGE_SAMPLE_SQUARES[1]).max(0.0)).sum());
    best
}

/// Power that is larger in a part of the spectrum.
/// `density` is that of the noise at a frequency, over that of white noise of variance 1.
fn lines(z: &[f64], density: impl Fn(f64) -> f64, doubt: &Doubt) -> Finding {
    let step_hz = RATE_HZ / z.len() as f64;
    let powers: Vec<f64> = powers(z).iter().enumerate().map(|(k, power)| power / density(k as f64 * step_hz)).collect();
    let first = (LINES_LOWEST_HZ / step_hz) as usize;
    let cumulative = cumulative_sums(powers.iter().copied());
    let allowed = 1.0 + tolerance(z.len()) + doubt.of_all(LINES_DOUBT);
    let mut best = Finding { what: "lines", log_p: 0.0, excess: 0.0 };
    for width in LINES.into_iter().filter(|&width| first + 4 * width <= powers.len()) {
        let count = width as f64;
        let sum = largest_sum(&cumulative, first, width);
        let log_p = log_tail(2.0 * count, 2.0 * sum / allowed) + log_windows(powers.len(), count, LINES.len());
        if log_p < best.log_p {
            best = Finding { log_p, excess: 2.0 * (sum - count), ..best };
        }
    }
    best
}

/// Noise whose variance wanders over seconds to minutes: the spread of the mean squares of successive parts.
fn slow_variance(z: &[f64], doubt: &Doubt) -> Finding {
    let length = SLOW_VARIANCE_SAMPLES as f64;
    let mean_square =
        |part: &[f64]| part.iter().map(|z| (z * z).min(SLOW_VARIANCE_LARGEST_SQUARE)).sum::<f64>() / length;
    let means: Vec<f64> = z.chunks_exact(SLOW_VARIANCE_SAMPLES).map(mean_square).collect();
    let n = means.len() as f64;
    if n < SLOW_VARIANCE_LEAST_PARTS {
        return Finding { what: "variance", log_p: 0.0, excess: 0.0 };
    }
    let mean = means.iter().sum::<f64>() / n;
    let spread = 2.0 / length * mean * mean * SLOW_VARIANCE_SPREAD;
    let changes = tolerance_that_changes(z.len());
    let doubts: Vec<f64> = doubt.of_samples(SLOW_VARIANCE_DOUBT).collect();
    let allowed =
        doubts.chunks_exact(SLOW_VARIANCE_SAMPLES).map(|part| (changes + part.iter().sum::<f64>() / length) * mean);
    let of_part = |(part, allowed): (&f64, f64)| (part - mean).powi(2) / (spread + allowed.powi(2));
    let chi_squared = means.iter().zip(allowed).map(of_part).sum::<f64>();
    let excess = means.iter().map(|part| (part - mean).abs()).sum::<f64>() * length * 0.5;
    Finding { what: "variance", log_p: log_tail(n - 1.0, chi_squared), excess }
}

/// The GLRT of some columns together, everything fitted projected out, in a residual `z` of variance 1: as in the search, it may have more
/// where the noise of the direction is let through.
fn of_columns(what: &'static str, selection: &Selection<'_>, z: &[f64], raw: &[Vec<f64>]) -> Finding {
    let mut projected = selection.problem.projected(raw, &selection.fit.projection);
    // A column that would not show with a coefficient of 100 nT is the noise of the direction.
    projected.retain(|column| dot(column, column) * COLUMN_LARGEST_NT * COLUMN_LARGEST_NT > 1.0);
    if projected.is_empty() {
        return Finding { what, log_p: 0.0, excess: 0.0 };
    }
    let (glrt, _, rank) = solve(&projected, z);
    let (glrt, dof) = (glrt / (1.0 + selection.noise.denser(&projected)), rank as f64);
    let log_p = log_tail(dof, glrt / (1.0 + tolerance(z.len())));
    Finding { what, log_p, excess: glrt - dof }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    #[test]
    fn long_stretches_of_noise_are_no_burst() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        let z: Vec<f64> = (0..12_000).map(|_| StandardNormal.sample(&mut random)).collect();
        for variance_cv in [0.0, 0.2, 0.5] {
            let doubt = Doubt::where_it(|_| true, z.len(), variance_cv);
            assert!(bursts(&z, &doubt).log_p > -5.0);
            assert!(lines(&z, |_| 1.0, &doubt).log_p > -5.0);
            assert!(slow_variance(&z, &doubt).log_p > -5.0);
        }
    }

    #[test]
    fn what_is_louder_shows_where_no_noise_of_the_direction_is_however_much_of_it_is_elsewhere() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut z: Vec<f64> = (0..6_000).map(|_| StandardNormal.sample(&mut random)).collect();
        // Two and a half times as loud for half a minute in ten.
        z[3_000..3_300].iter_mut().for_each(|z| *z *= 2.5);
        let doubt_in = |rows: std::ops::Range<usize>| Doubt::where_it(|k| rows.contains(&k), z.len(), 4.0);
        assert!(bursts(&z, &doubt_in(1_000..1_300)).log_p < -100.0);
        assert!(slow_variance(&z, &doubt_in(1_000..1_300)).log_p < -100.0);
        assert!(bursts(&z, &doubt_in(3_000..3_300)).log_p > -5.0);
    }
}
