//! How loud what is: the model that makes a recording likeliest, of those that leave targets alone.

use rayon::prelude::*;

use super::eaten::eaten;
use super::kalman::{Model, Start, likelihood};
use super::series::Sample;

/// Steps of the search, as powers of ten: first coarse, then to a factor of 1.8, where the likelihood is flat already.
const STEPS: [f64; 3] = [1.0, 0.5, 0.25];
/// Powers over that of the reading's noise that are looked at, as powers of ten. A quieter one cannot be told from none.
const LEAST: f64 = -12.0;
const MOST: f64 = 8.0;
/// The search goes uphill from the likeliest of all combinations of these.
const FIRST: [&[f64]; 3] = [&[-4.0, -1.0, 2.0, 5.0], &[-4.0, -1.0, 2.0, 5.0], &[-8.0, -4.0, -1.0, 2.0]];

/// Powers of ten of background, slope and coefficients.
pub(crate) type Exponents = [f64; 3];

fn model(exponents: Exponents, noise_nt2: f64) -> Model {
    let [background, slope, coefficients] = exponents.map(|exponent| 10_f64.powf(exponent));
    Model { noise_nt2, background, slope, coefficients }
}

/// A model that was tried.
#[derive(Clone, Copy)]
struct Tried {
    log: f64,
    at: Exponents,
    noise_nt2: f64,
}

/// The search for a model of some samples.
pub(crate) struct Search<'a> {
    pub(crate) samples: &'a [Sample],
    pub(crate) start: &'a Start,
    /// Which of background, slope and coefficients move at all.
    pub(crate) moves: [bool; 3],
    /// The share of a target that nobody has found which may go into the interference because coefficients move;
    /// `None` where no target is at stake.
    pub(crate) most_eaten: Option<f64>,
    /// The largest power of the coefficients' random steps, nT^2/s.
    pub(crate) most_moving_nt2_per_s: f64,
}

impl Search<'_> {
    /// The likeliest model, by steps along one power at a time; from `first` on, or from the best of a coarse grid.
    pub(crate) fn likeliest(&self, first: Option<Model>) -> Model {
        let guess_nt2 = first.map_or(1e-2, |model| model.noise_nt2);
        // The noise is free: its variance for these powers is known after one pass.
        let begun = |at: Exponents| self.tried(at, self.tried(at, guess_nt2).noise_nt2);
        let exponents =
            |model: Model| [model.background, model.slope, model.coefficients].map(|power| power.log10().max(LEAST));
        let places = first.map_or_else(|| self.first(), |model| vec![exponents(model)]);
        let tried: Vec<Tried> = places.into_par_iter().map(begun).collect();
        let Some(mut best) = likeliest(tried) else { return model([LEAST; 3], 1.0) };
        for step in if first.is_some() { &STEPS[2..] } else { &STEPS[..] } {
            while let Some(better) = self.uphill(best, *step) {
                best = better;
            }
        }
        self.that_leaves_targets(best)
    }

    fn tried(&self, mut at: Exponents, noise_nt2: f64) -> Tried {
        at[2] = at[2].min((self.most_moving_nt2_per_s / noise_nt2).log10());
        let (log, noise_nt2) = likelihood(self.samples, self.start, &model(at, noise_nt2));
        Tried { log, at, noise_nt2 }
    }

    fn uphill(&self, from: Tried, step: f64) -> Option<Tried> {
        let tried: Vec<Tried> =
            self.neighbours(from.at, step).into_par_iter().map(|at| self.tried(at, from.noise_nt2)).collect();
        likeliest(tried).filter(|best| best.log > from.log)
    }

    /// With coefficients that move less, where they would take too much of a target along.
    fn that_leaves_targets(&self, from: Tried) -> Model {
        let mut best = from;
        let Some(most_eaten) = self.most_eaten else { return model(best.at, best.noise_nt2) };
        let held = Search { moves: [self.moves[0], self.moves[1], false], ..*self };
        let taken = |at: Exponents, noise_nt2: f64| eaten(self.samples, self.start, &model(at, noise_nt2));
        let fixed = |best: &Tried| [best.at[0], best.at[1], LEAST];
        while best.at[2] > LEAST && taken(best.at, best.noise_nt2) > taken(fixed(&best), best.noise_nt2) + most_eaten {
            let [background, slope, coefficients] = best.at;
            best = self.tried([background, slope, coefficients - STEPS[1]], best.noise_nt2);
            while let Some(better) = held.uphill(best, STEPS[1]) {
                best = better;
            }
        }
        model(best.at, best.noise_nt2)
    }

    fn first(&self) -> Vec<Exponents> {
        let of = |axis: usize| if self.moves[axis] { FIRST[axis] } else { &[LEAST][..] };
        let with = |background: f64, slope: f64| of(2).iter().map(move |last| [background, slope, *last]);
        of(0).iter().flat_map(|a| of(1).iter().flat_map(move |b| with(*a, *b))).collect()
    }

    fn neighbours(&self, at: Exponents, step: f64) -> Vec<Exponents> {
        let moved = |axis: usize, by: f64| {
            let mut at = at;
            at[axis] += by;
            (self.moves[axis] && (LEAST..=MOST).contains(&at[axis])).then_some(at)
        };
        (0..3).flat_map(|axis| [moved(axis, step), moved(axis, -step)]).flatten().collect()
    }
}

fn likeliest(tried: Vec<Tried>) -> Option<Tried> {
    tried.into_iter().max_by(|a, b| a.log.total_cmp(&b.log))
}
