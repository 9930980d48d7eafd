//! What makes the residual louder: inputs held against its squares. For what is random, but not everywhere alike.

use super::expression::{Expr, Function, scaled, times, var};
use super::left::Left;
use super::ridge::{Folded, Ridge};
use super::scene::{Scene, middle_and_width};
use crate::diagnosis::evidence::folds::parts;
use crate::diagnosis::numerics::cumulative_sums;

/// Squares count no more than this many times their mean: a few large ones are bursts.
const LARGEST: f64 = 16.0;
/// Spread of the squares of even noise, over their mean, and how much more there must be for anything to be told of it.
const EVEN: f64 = 2.0;
const LEAST_UNEVEN: f64 = 0.2;
/// Samples that are held out, and those about them that tell how loud it is just then.
const PART_SAMPLES: usize = 20;
const ABOUT_SAMPLES: usize = 40;

/// How much of what is uneven in the loudness an input explains on parts held out.
pub(super) struct Louder {
    pub(super) input: String,
    pub(super) share: f64,
    pub(super) over: Expr,
}

/// Of every input, and of time.
pub(super) fn louder(left: &Left<'_, '_>, scene: &Scene) -> Vec<Louder> {
    let (squares, uneven) = squares(&left.z);
    if uneven <= LEAST_UNEVEN {
        return Vec::new();
    }
    let whole = uneven * squares.len() as f64;
    let rows: Vec<usize> = left.problem.whitening.rows().collect();
    let parts = parts(&left.problem.whitening.ranges(), PART_SAMPLES);
    let of = |(input, shapes): (String, Vec<Expr>)| {
        let columns: Vec<Vec<f64>> =
            shapes.iter().filter_map(|shape| Some(centred(&shape.evaluate(scene)?, &rows))).collect();
        if columns.is_empty() {
            return None;
        }
        let folded = Folded::new(&columns, &squares, &parts);
        let (prior, _) = Ridge::of(&folded.all).best();
        Some(Louder { input, share: folded.held_out(prior) / whole, over: shapes[0].clone() })
    };
    let mut all: Vec<Louder> = inputs(scene).into_iter().filter_map(of).collect();
    all.push(Louder { input: "time_irregular".into(), share: by_time(&squares) / whole, over: var("t") });
    all
}

/// Squares over their mean less 1, and how much more uneven they are than those of even noise.
fn squares(z: &[f64]) -> (Vec<f64>, f64) {
    let n = z.len().max(1) as f64;
    let rough = (z.iter().map(|z| z * z).sum::<f64>() / n).max(f64::MIN_POSITIVE);
    let cut: Vec<f64> = z.iter().map(|z| (z * z / rough).min(LARGEST)).collect();
    let mean = cut.iter().sum::<f64>() / n;
    let squares: Vec<f64> = cut.iter().map(|x| x / mean - 1.0).collect();
    let spread = squares.iter().map(|x| x * x).sum::<f64>() / n;
    (squares, (spread - EVEN) / (1.0 + EVEN))
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
    let unit = |name: &str| {
        let own = var(name);
        let (middle, width) = scene.variable(name).map_or((0.0, 1.0), middle_and_width);
        scaled(&own, middle, if width > 0.0 { width } else { 1.0 })
    };
    let powers = |unit: &Expr, to: usize| {
        (1..=to).map(|n| (0..n).fold(Expr::Number(1.0), |p, _| times(&p, unit))).collect::<Vec<_>>()
    };
    let axes = ["cx", "cy", "cz"].map(unit);
    let mut attitude: Vec<Expr> = axes.iter().flat_map(|axis| powers(axis, 4)).collect();
    attitude.extend((0..3).map(|i| times(&axes[i], &axes[(i + 1) % 3])));
    let rates = ["dcx", "dcy", "dcz"].map(unit);
    let rate =
        rates.iter().flat_map(|rate| [rate.clone().apply(Function::Abs), times(rate, rate), rate.clone()]).collect();
    let slope = var("s").through(super::filter::Filter::Rate);
    let slope_width = slope.evaluate(scene).map_or(1.0, |values| middle_and_width(&values).1.max(f64::MIN_POSITIVE));
    let slope = scaled(&slope, 0.0, slope_width);
    let reading = [vec![slope.clone().apply(Function::Abs), times(&slope, &slope)], powers(&unit("s"), 3)].concat();
    let mut all = vec![("attitude".into(), attitude), ("attitude_rate".into(), rate), ("reading".into(), reading)];
    for name in ["depth", "temperature"].into_iter().chain(scene.columns.iter().map(String::as_str)) {
        if scene.variable(name).is_some() {
            all.push((name.into(), powers(&unit(name), 3)));
        }
    }
    all
}
