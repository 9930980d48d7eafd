//! `load_current` without a recorded current: period, duty and phase from what is left, folded.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::Candidate;
use super::tone::transform;
use crate::gap::bench::{Bench, Fit};
use crate::gap::span::explained;
use crate::gap::term::{Term, neighbours};

/// Rows per second.
const RATE_HZ: f64 = 10.0;
/// Periods that are looked for, s; the longest also not above a third of the recording.
const PERIODS_S: [f64; 2] = [1.0, 300.0];
/// Numbers of harmonics that are added up.
const HARMONICS: [usize; 4] = [1, 3, 6, 12];
/// Periods that are folded, of each number of harmonics.
const FOLDED: usize = 4;
/// Shares of a period that are tried first.
const DUTIES: [f64; 9] = [0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7];
/// Parts of a period that a fold tells apart, at most.
const BINS: usize = 100;
/// Independent pulse trains per row of the recording: with it, half of 96 clean recordings have a best chance below one
/// half.
const TRIALS_PER_ROW: f64 = 300.0;
/// Folds that are fitted.
const FITTED: usize = 4;

pub(super) fn scan(bench: &Bench<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let search = Search::new(bench, fit);
    // A long period shows by its harmonics alone, the background has its fundamental: multiples are tried too.
    let periods_s: Vec<f64> =
        search.periods_s().into_iter().flat_map(|period_s| [1.0, 2.0, 3.0].map(|times| times * period_s)).collect();
    let mut folds: Vec<Fold> = periods_s.into_par_iter().filter_map(|period_s| search.best_near(period_s)).collect();
    folds.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    folds.dedup_by(|a, b| (a.period_s - b.period_s).abs() < 1e-3 * a.period_s);
    let fitted = folds.par_iter().take(FITTED).map(|fold| {
        let mut term =
            Term { effect, at: vec![0.0, 0.0, 0.0, fold.period_s, fold.duty, fold.phase], coordinates: vec![0.0; 3] };
        let gain = bench.gain(&mut term, &fit.span, &fit.rest);
        (gain, term)
    });
    let (_, term) = fitted.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (gain, term) = polished(bench, fit, term);
    let trials = RATE_HZ * bench.duration_s() * TRIALS_PER_ROW;
    Some(Candidate { term, gain, freedom: 3.0, trials, variance: None })
}

/// Period, phase and duty to a row, everything else held.
fn polished(bench: &Bench<'_>, fit: &Fit, term: Term) -> (f64, Term) {
    let mut best = term;
    let mut gain = bench.gain(&mut best, &fit.span, &fit.rest);
    // Duties are folded in steps of a tenth of a long period: the edges may be seconds off.
    let mut scale = 64.0;
    while scale > 0.8 {
        let tried: Vec<(f64, Term)> = neighbours("load_current", &best.at, bench.duration_s(), scale)
            .into_par_iter()
            .map(|at| {
                let mut other = Term { at, ..best.clone() };
                (bench.gain(&mut other, &fit.span, &fit.rest), other)
            })
            .collect();
        match tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((better, term)) if better > gain => (gain, best) = (better, term),
            _ => scale *= 0.5,
        }
    }
    (gain, best)
}

/// A period with its best phase and duty.
struct Fold {
    gain: f64,
    period_s: f64,
    duty: f64,
    phase: f64,
}

/// What is left times each cosine of the direction, ready to be folded.
struct Search<'a> {
    bench: &'a Bench<'a>,
    left: Vec<[f64; 3]>,
    /// Mean products of the cosines.
    moments: DMatrix<f64>,
    samples: f64,
}

impl<'a> Search<'a> {
    fn new(bench: &'a Bench<'a>, fit: &Fit) -> Self {
        let adjoint = bench.whitener.transposed(&fit.rest, bench.signals.len());
        let direction = &bench.signals.rows().direction;
        let left = adjoint.iter().zip(direction).map(|(left, c)| c.map(|cosine| cosine * left)).collect();
        let samples = bench.whitener.samples() as f64;
        let mean = |i: usize, j: usize| {
            bench.whitener.rows().map(|row| direction[row][i] * direction[row][j]).sum::<f64>() / samples
        };
        Self { bench, left, moments: DMatrix::from_fn(3, 3, mean), samples }
    }

    /// Periods whose harmonics stand out.
    fn periods_s(&self) -> Vec<f64> {
        let epochs_s = self.bench.signals.epochs_s();
        let component = |i: usize| transform(&self.left.iter().map(|left| left[i]).collect::<Vec<_>>(), epochs_s);
        let [(step_hz, x), (_, y), (_, z)] = [0, 1, 2].map(component);
        let inverse = pseudo_inverse(&self.moments);
        let half = x.len() / 2;
        let powers: Vec<f64> = (0..half)
            .map(|k| {
                let parts = [
                    DVector::from_vec(vec![x[k].re, y[k].re, z[k].re]),
                    DVector::from_vec(vec![x[k].im, y[k].im, z[k].im]),
                ];
                let squares: f64 = parts.iter().map(|part| part.dot(&(&inverse * part))).sum();
                let response = self.bench.whitener.predictor().response(k as f64 * step_hz / RATE_HZ);
                2.0 * squares / (self.samples * response)
            })
            .collect();
        let longest_s = PERIODS_S[1].min(self.bench.duration_s() / 3.0);
        let (from, to) =
            ((1.0 / longest_s / step_hz).ceil() as usize, ((1.0 / PERIODS_S[0] / step_hz) as usize).min(half));
        let mut periods = Vec::new();
        for count in HARMONICS {
            let mut scores: Vec<(f64, f64)> = (4 * from.max(1)..4 * to)
                .map(|quarter| {
                    // Quarters of a step: the harmonics multiply what the fundamental is off.
                    let fundamental = 0.25 * quarter as f64;
                    let harmonics = (1..=count).map(|h| (fundamental * h as f64).round() as usize);
                    let used: Vec<usize> = harmonics.take_while(|&k| k < half).collect();
                    let sum: f64 = used.iter().map(|&k| powers[k]).sum();
                    ((sum - 6.0 * used.len() as f64) / (used.len() as f64).sqrt(), 1.0 / (fundamental * step_hz))
                })
                .collect();
            scores.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut taken: Vec<f64> = Vec::new();
            for (_, period_s) in scores {
                if taken.iter().all(|other| (other / period_s - 1.0).abs() > 0.5 * period_s / self.bench.duration_s()) {
                    taken.push(period_s);
                }
                if taken.len() == FOLDED {
                    break;
                }
            }
            periods.extend(taken);
        }
        periods
    }

    /// The best fold at a period, or so near to it that the ends of the recording move by less than a row.
    fn best_near(&self, period_s: f64) -> Option<Fold> {
        let step = 0.1 * period_s / self.bench.duration_s();
        (-12..=12)
            .filter_map(|k| self.fold(period_s + 0.5 * f64::from(k) * step))
            .max_by(|a, b| a.gain.total_cmp(&b.gain))
    }

    fn fold(&self, period_s: f64) -> Option<Fold> {
        let bins = ((period_s * RATE_HZ).round() as usize).clamp(4, BINS);
        let mut sums = vec![[0.0; 3]; 2 * bins + 1];
        let mut folded = vec![[0.0; 3]; bins];
        for (left, time_s) in self.left.iter().zip(self.bench.signals.epochs_s()) {
            let cycles = time_s / period_s;
            let bin = (((cycles - cycles.floor()) * bins as f64) as usize).min(bins - 1);
            (0..3).for_each(|i| folded[bin][i] += left[i]);
        }
        for k in 0..2 * bins {
            for i in 0..3 {
                sums[k + 1][i] = sums[k][i] + folded[k % bins][i];
            }
        }
        let inverse = pseudo_inverse(&self.moments);
        let mut best: Option<Fold> = None;
        for duty in DUTIES {
            let width = (duty * bins as f64).round() as usize;
            if width == 0 || width >= bins {
                continue;
            }
            let duty = width as f64 / bins as f64;
            let power = self.power(period_s, duty);
            for start in 0..bins {
                let q = DVector::from_fn(3, |i, _| sums[start + width][i] - sums[start][i]);
                let gain = q.dot(&(&inverse * &q)) / power;
                if best.as_ref().is_none_or(|best| gain > best.gain) {
                    let phase = (1.0 - start as f64 / bins as f64).rem_euclid(1.0);
                    best = Some(Fold { gain, period_s, duty, phase });
                }
            }
        }
        best
    }

    /// Whitened power of a unit pulse train, by its harmonics.
    fn power(&self, period_s: f64, duty: f64) -> f64 {
        let mut power = 0.0;
        let last = ((0.5 * RATE_HZ * period_s) as usize).min(200);
        for h in 1..=last {
            let amplitude = 2.0 * (std::f64::consts::PI * h as f64 * duty).sin() / (std::f64::consts::PI * h as f64);
            let hz = h as f64 / period_s;
            // The background takes what is below 0.05 Hz.
            let kept = if hz > 0.05 { 1.0 } else { 0.02 };
            power += 0.5 * amplitude * amplitude * kept * self.bench.whitener.predictor().response(hz / RATE_HZ);
        }
        (power * self.samples).max(f64::MIN_POSITIVE)
    }
}

fn pseudo_inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let unit = |k: usize| DVector::from_fn(3, |i, _| f64::from(u8::from(i == k)));
    DMatrix::from_columns(&[0, 1, 2].map(|k| explained(matrix, &unit(k)).1))
}
