//! `mains_alias`: one transform of the whitened residual shows every frequency; the best few are fitted.

use towmag_fourier::Complex;

use crate::diagnosis::policy::{RATE_HZ, TONES_PER_RESOLUTION};
use crate::diagnosis::regression::problem::{Fit, RegressionProblem, solve};
use crate::diagnosis::regression::term::{Term, regressors};
use crate::diagnosis::search::Candidate;

/// Peaks that are fitted, and where about each, in steps of the transform.
const FITTED: usize = 3;
const PARTS: [f64; 3] = [-0.5, 0.0, 0.5];

pub(crate) fn scan(problem: &RegressionProblem<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let [low_hz, high_hz] = problem.library[effect].spec().parameters[0].range;
    let at = |hz: f64| -> (f64, Term) {
        let columns = regressors(&*problem.library[effect], &problem.signals, &[hz, 1.0, 0.0]);
        let (glrt, coordinates, _) = solve(&problem.projected(&columns, &fit.projection), &fit.residual_whitened);
        (glrt, Term { effect, at: vec![hz, 0.0, 0.0], coordinates })
    };
    let tried = peaks_hz(problem, fit, [low_hz, high_hz]).into_iter().map(at);
    let (glrt, term) = tried.reduce(|best, tried| if tried.0 > best.0 { tried } else { best })?;
    let trials_factor = (high_hz - low_hz) * problem.duration_s() * TONES_PER_RESOLUTION;
    Some(Candidate { term, glrt, dof: 2.0, trials_factor, variance: None })
}

/// Frequencies on and about the highest peaks within a range, highest first, Hz.
fn peaks_hz(problem: &RegressionProblem<'_>, fit: &Fit, [low_hz, high_hz]: [f64; 2]) -> Vec<f64> {
    let adjoint = problem.whitening.transposed(&fit.residual_whitened, problem.signals.len());
    let (step_hz, spectrum) = transform(&adjoint, problem.signals.epochs_s());
    let samples = problem.whitening.samples() as f64;
    let power = |k: usize| {
        let hz = k as f64 * step_hz;
        2.0 * spectrum[k].norm_sqr() / (samples * problem.whitening.predictor().response(hz / RATE_HZ))
    };
    let from = (low_hz / step_hz).ceil() as usize;
    let to = ((high_hz / step_hz) as usize).min(spectrum.len() / 2);
    let powers: Vec<f64> = (0..=to).map(|k| if k < from { 0.0 } else { power(k) }).collect();
    let mut peaks: Vec<usize> =
        (from.max(1)..to).filter(|&k| powers[k] >= powers[k - 1] && powers[k] > powers[k + 1]).collect();
    peaks.sort_by(|&a, &b| powers[b].total_cmp(&powers[a]));
    let near = |peak: usize| PARTS.map(|part| (peak as f64 + part) * step_hz);
    peaks.into_iter().take(FITTED).flat_map(near).collect()
}

/// Transform of values at uneven times, each at the nearest tenth of a second: step in Hz, and amplitudes.
pub(crate) fn transform(values: &[f64], epochs_s: &[f64]) -> (f64, Vec<Complex<f64>>) {
    let last = epochs_s.last().copied().unwrap_or(0.0);
    let length = (2 * ((last * RATE_HZ) as usize + 2)).next_power_of_two();
    let mut spectrum = vec![Complex::default(); length];
    for (value, time_s) in values.iter().zip(epochs_s) {
        spectrum[(time_s * RATE_HZ).round() as usize].re += value;
    }
    towmag_fourier::forward(length).process(&mut spectrum);
    (RATE_HZ / length as f64, spectrum)
}
