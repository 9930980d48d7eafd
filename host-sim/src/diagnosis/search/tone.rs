//! `mains_alias`: one transform of what is left tells every frequency; the best few are fitted.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::diagnosis::regression::problem::{Fit, RegressionProblem, solve};
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

/// Rows per second.
const RATE_HZ: f64 = 10.0;
/// Frequencies that are fitted.
const FITTED: usize = 3;

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let [low_hz, high_hz] = problem.library[effect].spec().parameters[0].range;
    let left = problem.whitening.transposed(&fit.residual_whitened, problem.signals.len());
    let (step_hz, spectrum) = transform(&left, problem.signals.epochs_s());
    let power = |k: usize| {
        let hz = k as f64 * step_hz;
        let samples = problem.whitening.samples() as f64;
        2.0 * spectrum[k].norm_sqr() / (samples * problem.whitening.predictor().response(hz / RATE_HZ))
    };
    let from = (low_hz / step_hz).ceil() as usize;
    let to = ((high_hz / step_hz) as usize).min(spectrum.len() / 2);
    let powers: Vec<f64> = (0..=to).map(|k| if k < from { 0.0 } else { power(k) }).collect();
    let mut peaks: Vec<usize> =
        (from.max(1)..to).filter(|&k| powers[k] >= powers[k - 1] && powers[k] > powers[k + 1]).collect();
    peaks.sort_by(|&a, &b| powers[b].total_cmp(&powers[a]));
    let mut best: Option<(f64, f64, Vec<f64>, usize)> = None;
    for &peak in peaks.iter().take(FITTED) {
        for part in [-0.5, 0.0, 0.5] {
            let hz = (peak as f64 + part) * step_hz;
            let columns = regressors(&*problem.library[effect], &problem.signals, &[hz, 1.0, 0.0]);
            let (glrt, coordinates, rank) =
                solve(&problem.projected(&columns, &fit.projection), &fit.residual_whitened);
            if best.as_ref().is_none_or(|best| glrt > best.0) {
                best = Some((glrt, hz, coordinates, rank));
            }
        }
    }
    let (glrt, hz, coordinates, _) = best?;
    let trials_factor = (high_hz - low_hz) * problem.duration_s() * 2.0;
    let term = Term { effect, at: vec![hz, 0.0, 0.0], coordinates };
    Some(Candidate { term, glrt, dof: 2.0, trials_factor, variance: None })
}

/// Transform of values at uneven times, each at the nearest tenth of a second: step in Hz, and amplitudes.
pub(crate) fn transform(values: &[f64], epochs_s: &[f64]) -> (f64, Vec<Complex<f64>>) {
    let last = epochs_s.last().copied().unwrap_or(0.0);
    let length = (2 * ((last * RATE_HZ) as usize + 2)).next_power_of_two();
    let mut spectrum = vec![Complex::default(); length];
    for (value, time_s) in values.iter().zip(epochs_s) {
        spectrum[(time_s * RATE_HZ).round() as usize].re += value;
    }
    FftPlanner::new().plan_fft_forward(length).process(&mut spectrum);
    (RATE_HZ / length as f64, spectrum)
}
