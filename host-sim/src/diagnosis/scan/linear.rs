//! Effects that are linear in all parameters: one least-squares fit.

use super::Candidate;
use crate::diagnosis::bench::{Bench, Fit, solve};
use crate::diagnosis::term::{Term, signatures};

/// Share of its power that a signature must keep after the sweep to mean anything.
const LEAST_SHARE: f64 = 1e-7;

pub(super) fn scan(bench: &Bench<'_>, fit: &Fit, effect: usize) -> Option<Candidate> {
    let at = vec![0.0; bench.library[effect].spec().parameters.len()];
    let raw = signatures(&*bench.library[effect], &bench.signals, &at);
    let before: f64 = raw.iter().map(|column| norm(&bench.whitener.apply(column))).sum();
    let swept = bench.swept(&raw, &fit.span);
    let after: f64 = swept.iter().map(|column| norm(column)).sum();
    if after <= LEAST_SHARE * before {
        return None;
    }
    let (gain, coordinates, rank) = solve(&swept, &fit.rest);
    Some(Candidate { term: Term { effect, at, coordinates }, gain, freedom: rank as f64, trials: 1.0, variance: None })
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|x| x * x).sum()
}
