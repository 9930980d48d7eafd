//! Effects that are random from epoch to epoch: they show in the variance of what is left.

use super::Candidate;
use super::heading::{axis, half_sphere};
use crate::gap::bench::{Bench, Fit};
use crate::gap::term::Term;

/// Axes of a dead zone that are tried.
const AXES: usize = 300;
/// Half angles that are told apart, degrees.
const STEP_DEG: f64 = 0.5;
/// Widest half angle that is tried, degrees.
const WIDEST_DEG: f64 = 45.0;
/// Samples that a dead zone must hold, and must leave.
const LEAST_SAMPLES: f64 = 30.0;
/// Squares count no more than this: one spike is no variance.
const LARGEST_SQUARE: f64 = 30.0;

/// Growth of the variance that a noise model may miss by itself, where it grows most.
const LEAST_GROWTH: f64 = 0.25;

/// Steps of the fit of the direction's noise.
const STEPS: usize = 100;
/// Twice the log likelihood that the direction's noise must gain to be part of the noise model.
const DIRECTION_GAIN: f64 = 6.0;

/// Twice the log likelihood that a dead zone must gain in each half of the time.
const LEAST_GAIN_OF_HALF: f64 = 5.0;
/// Twice the log likelihood that noise in proportion to the slopes may gain within a dead zone.
const MOST_GAIN_OF_SLOPES: f64 = 12.0;
/// The same as a share of what the dead zone gains.
const MOST_SHARE_OF_SLOPES: f64 = 0.02;
/// Independent cones, as far as a whitened residual that is not quite normal tells them apart.
const CONES: f64 = 4000.0;

/// How much the variance of each sample grows.
#[derive(Clone, Debug)]
pub(in crate::gap) struct VarianceFit {
    /// Variance of each sample over what it is without the effect.
    pub(in crate::gap) growth: Vec<f64>,
    /// Standard error of the logarithm of the added variance.
    pub(in crate::gap) log_error: f64,
}

/// Twice the gain in log likelihood when the variance of `squares` is `a (1 + kappa v)` instead of `a`, `kappa`, and
/// the curvature by `ln kappa` there.
pub(in crate::gap) fn fit_variance(squares: &[f64], v: &[f64]) -> (f64, f64, f64) {
    let n = squares.len() as f64;
    let mean_v = v.iter().sum::<f64>() / n;
    let deviance = |log_kappa: f64| {
        let kappa = log_kappa.exp();
        let (mut scaled, mut logs) = (0.0, 0.0);
        for (square, v) in squares.iter().zip(v) {
            let growth = 1.0 + kappa * v;
            scaled += square / growth;
            logs += growth.ln();
        }
        n * (scaled / n).ln() + logs
    };
    let none = n * (squares.iter().sum::<f64>() / n).ln();
    if mean_v <= 0.0 {
        return (0.0, 0.0, 0.0);
    }
    let start = -mean_v.ln();
    let grid = (-14..=16).map(|k| start + 0.5 * f64::from(k));
    let best = grid.min_by(|a, b| deviance(*a).total_cmp(&deviance(*b))).unwrap_or(start);
    let (mut low, mut high) = (best - 0.5, best + 0.5);
    for _ in 0..24 {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if deviance(a) < deviance(b) { high = b } else { low = a }
    }
    let at = 0.5 * (low + high);
    let curvature = (deviance(at + 0.05) - 2.0 * deviance(at) + deviance(at - 0.05)) / 0.0025;
    (none - deviance(at), at.exp(), 0.5 * curvature)
}

/// `sample_jitter`: variance in proportion to the squared slope of the signal.
pub(super) fn scan_jitter(bench: &Bench<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let change = bench.library[effect].variance(&bench.signals, &[1.0])?;
    let v = innovation_variance(bench, &change.scalar_nt);
    let squares = squares(&fit.rest);
    let (gain, kappa, curvature) = fit_variance(&squares, &v);
    let sigma_s = (kappa * scale(&squares, &v, kappa)).sqrt();
    let term = Term { effect, at: vec![sigma_s], coordinates: Vec::new() };
    let growth: Vec<f64> = v.iter().map(|v| 1.0 + kappa * v).collect();
    if most_of(&growth) < 1.0 + LEAST_GROWTH {
        return None;
    }
    let log_error = if curvature > 0.0 { 1.0 / curvature.sqrt() } else { 1.0 };
    let variance = Some(VarianceFit { growth, log_error });
    Some(Candidate { term, gain, freedom: 1.0, trials: 2.0, variance })
}

/// `dead_zone`: variance larger within a cone, in either sense.
pub(super) fn scan_dead_zone(bench: &Bench<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let squares = squares(&fit.rest);
    let rows: Vec<usize> = bench.whitener.rows().collect();
    let direction = &bench.signals.rows().direction;
    let (n, all) = (squares.len() as f64, squares.iter().sum::<f64>());
    let bins = (90.0 / STEP_DEG) as usize;
    let of_axis = |azimuth_deg: f64, elevation_deg: f64| {
        let a = axis(azimuth_deg, elevation_deg);
        let mut histogram = vec![(0.0, 0.0); bins + 1];
        for (square, &row) in squares.iter().zip(&rows) {
            let c = direction[row];
            let u = (c[0] * a[0] + c[1] * a[1] + c[2] * a[2]).abs().min(1.0);
            let bin = (u.acos().to_degrees() / STEP_DEG) as usize;
            histogram[bin.min(bins)].0 += 1.0;
            histogram[bin.min(bins)].1 += square;
        }
        let (mut count, mut sum) = (0.0, 0.0);
        let mut best = (0.0, 0.0);
        for (bin, (of_bin, squares)) in histogram.iter().enumerate().take((WIDEST_DEG / STEP_DEG) as usize) {
            count += of_bin;
            sum += squares;
            let (inside, outside) = (sum / count, (all - sum) / (n - count));
            if count < LEAST_SAMPLES || n - count < LEAST_SAMPLES || inside <= outside {
                continue;
            }
            let gain = n * (all / n).ln() - count * inside.ln() - (n - count) * outside.ln();
            if gain > best.0 {
                best = (gain, (bin + 1) as f64 * STEP_DEG);
            }
        }
        best
    };
    let mut best = (0.0, 0.0, 0.0, 0.0);
    let mut consider = |azimuth_deg: f64, elevation_deg: f64| {
        let (gain, half_angle_deg) = of_axis(azimuth_deg, elevation_deg);
        if gain > best.0 {
            best = (gain, azimuth_deg, elevation_deg, half_angle_deg);
        }
        best
    };
    let mut found = (0.0, 0.0, 0.0, 0.0);
    for (azimuth_deg, elevation_deg) in half_sphere(AXES) {
        found = consider(azimuth_deg, elevation_deg);
    }
    for step_deg in [4.0, 2.0, 1.0, 0.5] {
        for (da, de) in
            [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7)]
        {
            let wider = 1.0 / found.2.to_radians().cos().max(0.1);
            found = consider(found.1 + da * step_deg * wider, (found.2 + de * step_deg).clamp(-90.0, 90.0));
        }
    }
    let (gain, azimuth_deg, elevation_deg, half_angle_deg) = found;
    if gain <= 0.0 {
        return None;
    }
    let azimuth_deg = (azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let at = vec![azimuth_deg, elevation_deg, half_angle_deg, 1.0];
    let a = axis(azimuth_deg, elevation_deg);
    let inside: Vec<bool> = rows
        .iter()
        .map(|&row| {
            let c = direction[row];
            let u = (c[0] * a[0] + c[1] * a[1] + c[2] * a[2]).abs().min(1.0);
            u.acos().to_degrees() <= half_angle_deg
        })
        .collect();
    if !holds(bench, &squares, &inside, gain) {
        return None;
    }
    let change = bench.library[effect].variance(&bench.signals, &at)?;
    let v = innovation_variance(bench, &change.scalar_nt);
    let (_, kappa, curvature) = fit_variance(&squares, &v);
    let mut at = at;
    at[3] = (kappa * scale(&squares, &v, kappa)).sqrt();
    let growth: Vec<f64> = v.iter().map(|v| 1.0 + kappa * v).collect();
    if growth.iter().copied().fold(0.0, f64::max) < 1.0 + LEAST_GROWTH {
        return None;
    }
    let log_error = if curvature > 0.0 { 1.0 / curvature.sqrt() } else { 1.0 };
    let term = Term { effect, at, coordinates: Vec::new() };
    Some(Candidate { term, gain, freedom: 2.0, trials: CONES, variance: Some(VarianceFit { growth, log_error }) })
}

/// Variance of whitened samples for a white addition of variance `row_variance`, one a row.
pub(in crate::gap) fn innovation_variance(bench: &Bench<'_>, row_variance: &[f64]) -> Vec<f64> {
    let by_lag = bench.whitener.predictor().squared_weights();
    let weights = bench.whitener.weights();
    let mut out = Vec::with_capacity(weights.len());
    for block in bench.whitener.blocks() {
        for row in block.rows.clone() {
            let sum: f64 = by_lag
                .iter()
                .take(row - block.rows.start + 1)
                .enumerate()
                .map(|(lag, w)| w * row_variance[row - lag])
                .sum();
            let weight = weights[out.len()];
            out.push(sum * weight * weight);
        }
    }
    out
}

/// How the variance of each sample grows by what is left of the fluxgate's noise and of the motion that it hides: they
/// enter through the 18 terms, more on some headings than on others. `rest` is whitened, without weights; the mean of
/// the growth is 1.
pub(in crate::gap) fn direction_growth(bench: &Bench<'_>, rest: &[f64]) -> Option<Vec<f64>> {
    let squares = squares(rest);
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    let parts: Vec<Vec<f64>> = slopes(bench)
        .iter()
        .map(|row_variance| innovation_variance(bench, row_variance))
        .filter_map(|part| {
            let own = part.iter().sum::<f64>() / n;
            (own > 0.0 && own.is_finite()).then(|| part.iter().map(|v| v / own).collect())
        })
        .collect();
    if parts.is_empty() || mean <= 0.0 {
        return None;
    }
    let (mut a, mut b) = (0.5 * mean, vec![0.5 * mean / parts.len() as f64; parts.len()]);
    let model = |a: f64, b: &[f64]| -> Vec<f64> {
        let mut model = vec![a; squares.len()];
        for (b, part) in b.iter().zip(&parts) {
            model.iter_mut().zip(part).for_each(|(m, v)| *m += b * v);
        }
        model
    };
    // Steps in proportion: nothing becomes negative, and the likelihood never falls.
    for _ in 0..STEPS {
        let at = model(a, &b);
        let pull: Vec<f64> = squares.iter().zip(&at).map(|(square, m)| square / (m * m)).collect();
        let factor = |of: &dyn Fn(usize) -> f64| {
            let up: f64 = pull.iter().enumerate().map(|(k, p)| p * of(k)).sum();
            let down: f64 = at.iter().enumerate().map(|(k, m)| of(k) / m).sum();
            (up / down.max(f64::MIN_POSITIVE)).sqrt()
        };
        a = (a * factor(&|_| 1.0)).max(1e-3 * mean);
        for (b, part) in b.iter_mut().zip(&parts) {
            *b *= factor(&|k| part[k]);
        }
    }
    let at = model(a, &b);
    let gain = n * mean.ln() + n - squares.iter().zip(&at).map(|(square, m)| square / m + m.ln()).sum::<f64>();
    let middle = at.iter().sum::<f64>() / n;
    (gain > DIRECTION_GAIN).then(|| at.iter().map(|m| m / middle).collect())
}

/// Squared change of the interference with each component of an error of the direction across it, and of its
/// derivative.
fn slopes(bench: &Bench<'_>) -> [Vec<f64>; 6] {
    let beta = &bench.signals.world().coefficients;
    let rows = bench.signals.rows();
    let of_row = |row: usize| {
        let (c, field_nt) = (rows.direction[row], rows.field_nt[row]);
        let [xx, xy, xz, yy, yz, zz] = [3, 4, 5, 6, 7, 8].map(|k| beta[k] * field_nt);
        let by_direction = [
            beta[0] + 2.0 * xx * c[0] + xy * c[1] + xz * c[2],
            beta[1] + xy * c[0] + 2.0 * yy * c[1] + yz * c[2],
            beta[2] + xz * c[0] + yz * c[1] + 2.0 * zz * c[2],
        ];
        let by_rate = [0, 1, 2].map(|j| (0..3).map(|i| field_nt * c[i] * beta[9 + 3 * i + j]).sum::<f64>());
        let across = |v: [f64; 3]| {
            let along = v[0] * c[0] + v[1] * c[1] + v[2] * c[2];
            [0, 1, 2].map(|k| (v[k] - along * c[k]).powi(2))
        };
        (across(by_direction), across(by_rate))
    };
    let all: Vec<([f64; 3], [f64; 3])> = (0..bench.signals.len()).map(of_row).collect();
    [0, 1, 2, 3, 4, 5].map(|k| all.iter().map(|(c, rate)| if k < 3 { c[k] } else { rate[k - 3] }).collect())
}

/// Whether the variance is larger within a cone in both halves of the time, and not with the slopes of the interference.
fn holds(bench: &Bench<'_>, squares: &[f64], inside: &[bool], gain_of_all: f64) -> bool {
    let n = squares.len();
    let gain = |least: f64, of: &dyn Fn(usize) -> bool| {
        let mut sums = [(0.0, 0.0); 2];
        for k in (0..n).filter(|&k| of(k)) {
            let sum = &mut sums[usize::from(inside[k])];
            *sum = (sum.0 + 1.0, sum.1 + squares[k]);
        }
        let [(outer, outer_sum), (inner, inner_sum)] = sums;
        if inner < least || outer < least {
            return None;
        }
        let (inside, outside) = (inner_sum / inner, outer_sum / outer);
        let all = (inner_sum + outer_sum) / (inner + outer);
        let gain = (inner + outer) * all.ln() - inner * inside.ln() - outer * outside.ln();
        Some(if inside > outside { gain } else { 0.0 })
    };
    let halves = match (gain(0.5 * LEAST_SAMPLES, &|k| k < n / 2), gain(0.5 * LEAST_SAMPLES, &|k| k >= n / 2)) {
        (Some(first), Some(second)) => [first, second],
        // Visited in one half alone: every other ten seconds.
        _ => [0, 1].map(|turn| gain(LEAST_SAMPLES, &|k| (k / 100) % 2 == turn).unwrap_or(0.0)),
    };
    if halves.iter().any(|gain| *gain < LEAST_GAIN_OF_HALF) {
        return false;
    }
    let within = |values: &[f64]| -> Vec<f64> {
        values.iter().zip(inside).filter(|(_, inside)| **inside).map(|(value, _)| *value).collect()
    };
    let squares = within(squares);
    let most = MOST_GAIN_OF_SLOPES.max(MOST_SHARE_OF_SLOPES * gain_of_all);
    slopes(bench).iter().all(|slope| {
        let v = within(&innovation_variance(bench, slope));
        fit_variance(&squares, &v).0 < most
    })
}

/// What a twentieth of the values is above.
fn most_of(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let at = (sorted.len() - 1) * 19 / 20;
    *sorted.select_nth_unstable_by(at, f64::total_cmp).1
}

fn squares(rest: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = rest.iter().map(|z| z * z).collect();
    let middle = all.len() / 2;
    let (_, median, _) = all.select_nth_unstable_by(middle, f64::total_cmp);
    let largest = LARGEST_SQUARE * 10.0 * *median;
    rest.iter().map(|z| (z * z).min(largest)).collect()
}

/// The common factor of the variances at their best.
fn scale(squares: &[f64], v: &[f64], kappa: f64) -> f64 {
    squares.iter().zip(v).map(|(square, v)| square / (1.0 + kappa * v)).sum::<f64>() / squares.len() as f64
}
