//! What makes the residual louder: inputs held against its squares. For what is random, but not everywhere alike.

use super::left::Left;
use crate::diagnosis::evidence::folds::parts;
use crate::diagnosis::numerics::cumulative_sums;
use crate::diagnosis::policy::DRIVER_LOUDNESS_LEAST_GAIN;
use crate::diagnosis::shapes::expression::{Expr, Function, power, scaled, times, var};
use crate::diagnosis::shapes::inputs::{reading_rate, tilts, turns};
use crate::diagnosis::shapes::ridge::{Folded, Ridge};
use crate::diagnosis::shapes::scene::{Scene, middle_and_width};

/// Inputs that no column of the recording has.
const IN_TIME: [&str; 2] = ["time_periodic", "time_irregular"];
/// Squares below this share of their mean count as so much: their logarithm has no end.
const LEAST: f64 = 1e-3;
/// Variance of the logarithm of the square of a normal value, cut off as above (without that it is a half of pi squared): by two
/// million draws.
const EVEN: f64 = 4.16;
/// Of what is uneven at least so much is counted as there, for a share of it to mean anything.
const LEAST_UNEVEN: f64 = 0.15;
/// Gain in log likelihood, beyond that of turned squares, from which an input says anything of them.
const LEAST_GAIN: f64 = 6.0;
/// Turns in time.
const TURNS: usize = 8;
/// Samples that are held out, and those about them that tell how loud it is just then.
const PART_SAMPLES: usize = 20;
const ABOUT_SAMPLES: usize = 40;

/// How much of what is uneven in the loudness an input explains on parts held out.
pub(super) struct Louder {
    pub(super) input: String,
    pub(super) share: f64,
}

/// Of every input, and of time.
pub(super) fn louder(left: &Left<'_>, scene: &Scene) -> Vec<Louder> {
    let (squares, uneven) = squares(&left.z);
    let whole = uneven.max(LEAST_UNEVEN) * squares.len() as f64;
    let rows: Vec<usize> = left.problem.whitening.rows().collect();
    let parts = parts(&left.problem.whitening.ranges(), PART_SAMPLES);
    let of = |(input, shapes): (String, Vec<Expr>)| {
        let columns: Vec<Vec<f64>> =
            shapes.iter().filter_map(|shape| Some(centred(&shape.evaluate(scene)?, &rows))).collect();
        if columns.is_empty() {
            return None;
        }
        let folded = Folded::new(&columns, &squares, &parts);
        let ridge = Ridge::of(&folded.all);
        let (prior, gain) = ridge.best();
        let beyond = gain - ridge.gains_of_turned(&columns, &squares, TURNS).fold(0.0, f64::max);
        let share = if beyond > LEAST_GAIN { folded.held_out(prior).1 / whole } else { 0.0 };
        let is_cause = beyond > DRIVER_LOUDNESS_LEAST_GAIN && comes_back(&input);
        let left = is_cause.then(|| by_time(&less(&squares, &columns, ridge.weights(prior).as_slice())) / whole);
        Some((beyond, left, Louder { input, share }))
    };
    let told: Vec<(f64, Option<f64>, Louder)> = inputs(scene).into_iter().filter_map(of).collect();
    let cause = told.iter().filter(|(_, left, _)| left.is_some()).max_by(|a, b| a.0.total_cmp(&b.0));
    let of_time = cause.and_then(|(_, left, _)| *left).unwrap_or_else(|| by_time(&squares) / whole);
    let mut all: Vec<Louder> = told.into_iter().map(|(_, _, louder)| louder).collect();
    all.push(Louder { input: "time_irregular".into(), share: of_time });
    // No input can explain more than all of it.
    let most = all.iter().map(|louder| louder.share).fold(1.0, f64::max);
    all.iter_mut().for_each(|louder| louder.share /= most);
    all
}

/// Whether an input was recorded.
pub(super) fn is_recorded(input: &str) -> bool {
    input != "none" && !IN_TIME.contains(&input)
}

/// Whether an input comes back to where it was within minutes: of one that goes one way, time tells as much.
pub(super) fn comes_back(input: &str) -> bool {
    is_recorded(input) && input != "temperature"
}

/// What a fit leaves of the squares.
fn less(squares: &[f64], columns: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut left = squares.to_vec();
    for (column, weight) in columns.iter().zip(weights) {
        left.iter_mut().zip(column).for_each(|(left, x)| *left -= weight * x);
    }
    left
}

/// Logarithms of the squares less their mean, and how much more they spread than those of even noise.
fn squares(z: &[f64]) -> (Vec<f64>, f64) {
    let n = z.len().max(1) as f64;
    let mean = (z.iter().map(|z| z * z).sum::<f64>() / n).max(f64::MIN_POSITIVE);
    let logarithms: Vec<f64> = z.iter().map(|z| (z * z / mean).max(LEAST).ln()).collect();
    let middle = logarithms.iter().sum::<f64>() / n;
    let squares: Vec<f64> = logarithms.iter().map(|x| x - middle).collect();
    let spread = squares.iter().map(|x| x * x).sum::<f64>() / n;
    (squares, spread - EVEN)
}

fn centred(column: &[f64], rows: &[usize]) -> Vec<f64> {
    let own: Vec<f64> = rows.iter().map(|&row| column[row]).collect();
    let n = own.len().max(1) as f64;
    let mean = own.iter().sum::<f64>() / n;
    let rms = (own.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt().max(f64::MIN_POSITIVE);
    own.iter().map(|x| (x - mean) / rms).collect()
}

/// Reduction of the squares' spread by the mean of those about a part, shrunk as it must be.
fn by_time(squares: &[f64]) -> f64 {
    let sums = cumulative_sums(squares.iter().copied());
    let of_part = |start: usize| {
        let end = (start + PART_SAMPLES).min(squares.len());
        let (from, to) = (start.saturating_sub(ABOUT_SAMPLES), (end + ABOUT_SAMPLES).min(squares.len()));
        let count = (to - from - (end - start)).max(1) as f64;
        let about = (sums[to] - sums[end] + sums[start] - sums[from]) / count;
        (about, sums[end] - sums[start], (end - start) as f64)
    };
    let all: Vec<(f64, f64, f64)> = (0..squares.len()).step_by(PART_SAMPLES).map(of_part).collect();
    let (product, size) =
        all.iter().fold((0.0, 0.0), |(p, s), (about, own, n)| (p + about * own, s + n * about * about));
    let shrunk = (product / size.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    all.iter().map(|(about, own, n)| 2.0 * shrunk * about * own - n * (shrunk * about).powi(2)).sum()
}

/// Inputs with what of them may make it loud.
fn inputs(scene: &Scene) -> Vec<(String, Vec<Expr>)> {
    let unit = |own: Expr| {
        let (middle, width) = own.evaluate(scene).map_or((0.0, 1.0), |values| middle_and_width(&values));
        scaled(&own, middle, if width > 0.0 { width } else { 1.0 })
    };
    let powers = |unit: &Expr, to: usize| (1..=to).map(|n| power(unit, n)).collect::<Vec<_>>();
    let axes = ["cx", "cy", "cz"].map(|axis| unit(var(axis)));
    let mut attitude: Vec<Expr> = axes.iter().flat_map(|axis| powers(axis, 4)).collect();
    attitude.extend((0..3).map(|i| times(&axes[i], &axes[(i + 1) % 3])));
    attitude.extend(tilts(scene).into_iter().flat_map(|tilt| powers(&unit(tilt), 4)));
    let rates = turns(scene).into_iter().map(|turn| {
        let width = turn.evaluate(scene).map_or(1.0, |values| middle_and_width(&values).1.max(f64::MIN_POSITIVE));
        scaled(&turn, 0.0, width)
    });
    let rate = rates.flat_map(|rate| [rate.clone().apply(Function::Abs), times(&rate, &rate), rate]).collect();
    let slope = reading_rate();
    let slope_width = slope.evaluate(scene).map_or(1.0, |values| middle_and_width(&values).1.max(f64::MIN_POSITIVE));
    let slope = scaled(&slope, 0.0, slope_width);
    // What is louder where the reading is steeper is read at times that jitter: nothing that was recorded drives a clock.
    let jitter = vec![slope.clone().apply(Function::Abs), times(&slope, &slope)];
    let mut all = vec![
        ("attitude".into(), attitude),
        ("attitude_rate".into(), rate),
        ("reading".into(), powers(&unit(var("s")), 3)),
        ("time_irregular".into(), jitter),
    ];
    for name in ["depth", "temperature"].into_iter().chain(scene.columns.iter().map(String::as_str)) {
        if scene.variable(name).is_some() {
            all.push((name.into(), powers(&unit(var(name)), 3)));
        }
    }
    all
}
