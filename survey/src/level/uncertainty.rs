//! Covariance of the coefficients given all rows: the forward filter and one that comes the other way, put together (Fraser
//! and Potter, The optimum linear smoother, IEEE Trans. Autom. Control 14, 1969). It changes slowly: knots are enough.

use nalgebra::SMatrix;

use super::kalman::{Filter, Model, STATES, Start};
use super::series::Sample;
use super::terms::COMBINATIONS;

/// Samples between two knots: 5 s, in which coefficients hardly move.
pub(crate) const KNOT_SAMPLES: usize = 10;

type States = SMatrix<f64, STATES, STATES>;
/// Covariance of the coefficients.
pub(crate) type Covariance = SMatrix<f64, COMBINATIONS, COMBINATIONS>;

/// The covariance at every knot.
pub(crate) fn knots(samples: &[Sample], start: &Start, model: &Model) -> Vec<Covariance> {
    let ahead = at_knots(samples, start, model, false);
    let reversed = reversed(samples);
    let back = at_knots(&reversed, &Start::unknown(), model, true);
    ahead.iter().zip(back.iter().rev()).map(|(ahead, back)| together(ahead, back)).collect()
}

/// Information at each knot: forwards with the knot's own row, backwards without it.
fn at_knots(samples: &[Sample], start: &Start, model: &Model, is_back: bool) -> Vec<States> {
    let mut filter = Filter::new(start);
    let mut knots = Vec::new();
    for (k, sample) in samples.iter().enumerate() {
        let row = if is_back { samples.len() - 1 - k } else { k };
        let is_knot = row.is_multiple_of(KNOT_SAMPLES);
        if is_knot && is_back {
            let mut predicted = filter.clone();
            predicted.predict(sample, model);
            knots.push(information(&predicted, true));
        }
        filter.step(sample, model);
        if is_knot && !is_back {
            knots.push(information(&filter, false));
        }
    }
    knots
}

fn information(filter: &Filter, is_back: bool) -> States {
    let sign = |k: usize| if is_back && k == STATES - 1 { -1.0 } else { 1.0 };
    let covariance = States::from_fn(|i, k| sign(i) * sign(k) * filter.covariance[i][k]);
    // A background that begins here is known from here on alone.
    covariance.cholesky().map_or_else(States::zeros, |factor| factor.inverse())
}

/// The start's own information is in both; it counts nothing where a recording tells.
fn together(ahead: &States, back: &States) -> Covariance {
    let all = (ahead + back).cholesky().map_or_else(States::zeros, |factor| factor.inverse());
    all.fixed_view::<COMBINATIONS, COMBINATIONS>(0, 0).into_owned()
}

/// The rows the other way: what begins at a row ends what comes after it.
fn reversed(samples: &[Sample]) -> Vec<Sample> {
    let mut reversed: Vec<Sample> = samples.iter().rev().copied().collect();
    for (k, sample) in reversed.iter_mut().enumerate() {
        let next = (k > 0).then(|| samples[samples.len() - k]);
        (sample.begins, sample.moved, sample.step_s) =
            next.map_or((true, false, 0.0), |next| (next.begins, next.moved, next.step_s));
    }
    reversed
}
