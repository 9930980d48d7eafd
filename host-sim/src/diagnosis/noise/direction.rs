//! What the fluxgate's noise adds to the variance of the residual.

use super::variance::{innovation_variance, squares};
use super::whitening::Whitening;
use crate::diagnosis::reconstruct::tangent_plane::sixth_difference;
use crate::simulator::signals::Signals;

/// Steps of the fit.
const STEPS: usize = 100;
/// What errs in the direction, over its noise, and in its rate, 1/s: smoothing leaves less than the noise of the one and
/// passes little above 2 Hz of the other, but errs by more than that where a motion sets in.
const MOST_DIRECTION: f64 = 3.0;
const MOST_RATE_PER_S: f64 = 20.0;
/// Error of the rate over the direction's sixth difference, 1/s.
const MOST_BETWEEN: f64 = 1.0;
/// Twice the log likelihood that the direction's noise must gain to be part of the noise model.
const LEAST_GAIN: f64 = 6.0;

/// How the variance of each sample grows by what is left of the fluxgate's noise and of the motion that it hides: they
/// enter through the 18 terms, more on some headings than on others. `residual_whitened` is whitened, without weights; the mean of
/// the growth is 1. `noise_rad` is the direction's noise as it was read: what is more than it can make is no noise of
/// the direction.
pub(crate) fn direction_growth(
    signals: &Signals,
    whitening: &Whitening,
    rest: &[f64],
    noise_rad: f64,
) -> Option<Vec<f64>> {
    let squares = squares(rest, None);
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    let [direction, rate] = [MOST_DIRECTION, MOST_RATE_PER_S].map(|most| (most * noise_rad).powi(2));
    let most = [direction, direction, direction, rate, rate, rate, MOST_BETWEEN * MOST_BETWEEN];
    // Each part, its mean 1, and what it may be at most.
    let (parts, most): (Vec<Vec<f64>>, Vec<f64>) = slopes(signals)
        .iter()
        .chain(std::iter::once(&between_rows(signals)))
        .map(|row_variance| innovation_variance(whitening, row_variance))
        .zip(most)
        .filter_map(|(part, most)| {
            let own = part.iter().sum::<f64>() / n;
            (own > 0.0 && own.is_finite()).then(|| (part.iter().map(|v| v / own).collect::<Vec<f64>>(), own * most))
        })
        .unzip();
    if parts.is_empty() || mean <= 0.0 {
        return None;
    }
    let mut a = 0.5 * mean;
    let mut b: Vec<f64> = most.iter().map(|most| (0.5 * mean / parts.len() as f64).min(*most)).collect();
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
        for ((b, part), most) in b.iter_mut().zip(&parts).zip(&most) {
            *b = (*b * factor(&|k| part[k])).min(*most);
        }
    }
    let at = model(a, &b);
    let glrt = n * mean.ln() + n - squares.iter().zip(&at).map(|(square, m)| square / m + m.ln()).sum::<f64>();
    let middle = at.iter().sum::<f64>() / n;
    (glrt > LEAST_GAIN).then(|| at.iter().map(|m| m / middle).collect())
}

/// Squared change of the interference with an error of the rate where the motion has what rows at 10 Hz cannot resolve:
/// where a hand or a wave sets in, the rate is off for a row or two. The sixth difference of the direction shows it.
fn between_rows(signals: &Signals) -> Vec<f64> {
    let direction = &signals.rows().direction;
    let n = direction.len();
    let sharp: Vec<f64> = (0..n)
        .map(|row| {
            let Some(near) = row.checked_sub(3).and_then(|first| direction.get(first..row + 4)) else { return 0.0 };
            sixth_difference(near).into_iter().map(|component| component * component).sum()
        })
        .collect();
    let [_, _, _, x, y, z] = slopes(signals);
    let beside = |row: usize| sharp[row.saturating_sub(1)..(row + 2).min(n)].iter().copied().fold(0.0, f64::max);
    (0..n).map(|row| (x[row] + y[row] + z[row]) * beside(row)).collect()
}

/// Squared change of the interference with each component of an error of the direction across it, and of its
/// derivative.
pub(crate) fn slopes(signals: &Signals) -> [Vec<f64>; 6] {
    let beta = &signals.trajectory().coefficients;
    let rows = signals.rows();
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
    let all: Vec<([f64; 3], [f64; 3])> = (0..signals.len()).map(of_row).collect();
    [0, 1, 2, 3, 4, 5].map(|k| all.iter().map(|(c, rate)| if k < 3 { c[k] } else { rate[k - 3] }).collect())
}
