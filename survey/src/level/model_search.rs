//! How loud what is: the model that makes a recording likeliest.

use rayon::prelude::*;

use super::kalman::{Model, Start, likelihood};
use super::series::Sample;

/// Steps of the search, as powers of ten: first coarse, then to a factor of 1.8, where the likelihood is flat already.
const STEPS: [f64; 3] = [1.0, 0.5, 0.25];
/// Powers over that of the reading's noise that are looked at, as powers of ten. A quieter one cannot be told from none.
const RANGE: [std::ops::RangeInclusive<f64>; 3] = [-7.0..=4.0, -9.0..=4.0, -12.0..=3.0];
/// Where the search begins: the lake scenario's.
const FIRST: [f64; 3] = [0.0, -1.0, -6.0];

/// Powers of ten of background, slope and coefficients.
type Exponents = [f64; 3];

fn model(exponents: Exponents, noise_nt2: f64) -> Model {
    let [background, slope, coefficients] = exponents.map(|exponent| 10_f64.powf(exponent));
    Model { noise_nt2, background, slope, coefficients }
}

fn exponents(model: &Model) -> Exponents {
    [model.background, model.slope, model.coefficients].map(f64::log10)
}

/// The likeliest model, by steps along one power at a time from `first` on, or from the usual place.
pub(crate) fn likeliest(samples: &[Sample], start: &Start, first: Option<Model>) -> Model {
    let judged = |at: Exponents, noise_nt2: f64| {
        // The noise is free: its variance for these powers is known after one pass, and the start hardly feels it.
        let (log, noise_nt2) = likelihood(samples, start, &model(at, noise_nt2));
        (log, at, noise_nt2)
    };
    let mut best = judged(first.as_ref().map_or(FIRST, exponents), first.map_or(1e-2, |model| model.noise_nt2));
    best = judged(best.1, best.2);
    for step in if first.is_some() { &STEPS[2..] } else { &STEPS[..] } {
        loop {
            let tried: Vec<_> = neighbours(best.1, *step).into_par_iter().map(|at| judged(at, best.2)).collect();
            let Some(next) = tried.into_iter().filter(|next| next.0 > best.0).max_by(|a, b| a.0.total_cmp(&b.0)) else {
                break;
            };
            best = next;
        }
    }
    model(best.1, best.2)
}

fn neighbours(at: Exponents, step: f64) -> Vec<Exponents> {
    let moved = |axis: usize, by: f64| {
        let mut at = at;
        at[axis] += by;
        RANGE[axis].contains(&at[axis]).then_some(at)
    };
    (0..3).flat_map(|axis| [moved(axis, step), moved(axis, -step)]).flatten().collect()
}
