//! What lives in time alone: tones that keep their phase over the whole recording, a moment or a delay that drifts, wanders, or jumps
//! once.

use towmag_fourier::Complex;

use super::left::Left;
use crate::diagnosis::policy::{EPOCH_S, RATE_HZ};
use crate::diagnosis::regression::problem::solve;
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, scaled, times, var};
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs::reading_rate;
use crate::diagnosis::shapes::scene::{Scene, middle_and_width};

/// Tones below this are background, Hz.
const LEAST_HZ: f64 = 0.01;
/// Points of the transform for one of the recording: a tone between two of them is not lost.
const PADDING: usize = 4;
/// Multiples of a tone that are fitted with it.
const HARMONICS: usize = 4;
/// Half periods of a slow course over the recording.
const SLOW: std::ops::RangeInclusive<u32> = 1..=8;
/// Pieces in which a moment may wander: none shorter than this, s, and no more than so many.
const PIECE_S: f64 = 5.0;
const MOST_PIECES: usize = 60;
/// Places at which a jump is looked for at first, and how often its place is looked for anew between its neighbours.
const PLACES: usize = 60;
const ROUNDS: usize = 3;
/// Of the recording, the part at each end in which no jump is looked for: a tenth. Nearer to it a jump is little but a moment that stays.
const ENDS: usize = 10;

/// Groups that follow time, each with what else was tried of it.
pub(super) fn groups(left: &Left<'_>, scene: &Scene) -> Vec<Vec<Group>> {
    let axes = ["cx", "cy", "cz"].map(var);
    let one = Expr::Number(1.0);
    let moment: Vec<Expr> = [one.clone()].into_iter().chain(axes.clone()).collect();
    let late = vec![reading_rate()];
    let mut all = Vec::new();
    for (form, by) in
        [(DriverForm::Additive, vec![one]), (DriverForm::Additive, moment.clone()), (DriverForm::Delay, late.clone())]
    {
        all.extend(tone(left, scene, form, &by).map(|tone| vec![tone]));
        all.extend(jump(left, scene, form, &by).map(|jump| vec![jump]));
    }
    all.extend(trends(scene).map(|trend| vec![trend]));
    all.push(vec![slow(scene, DriverForm::Additive, &axes)]);
    all.push(vec![slow(scene, DriverForm::Delay, &late)]);
    all.push(vec![pieces(scene, &axes)]);
    all
}

fn group(input: &str, form: DriverForm, shapes: Vec<Expr>, tried: f64) -> Group {
    Group { input: input.into(), form, shapes, over: var("t"), tried, without_input: 0 }
}

fn turning(hz: f64, function: Function) -> Expr {
    Expr::Product(vec![Expr::Number(std::f64::consts::TAU * hz), var("t")]).apply(function)
}

fn all_times(courses: impl Iterator<Item = Expr>, by: &[Expr]) -> Vec<Expr> {
    courses.flat_map(|course| by.iter().map(move |by| times(by, &course))).collect()
}

/// The tone that fits best, with its multiples.
fn tone(left: &Left<'_>, scene: &Scene, form: DriverForm, by: &[Expr]) -> Option<Group> {
    let rows = scene.rows();
    let gradient = left.problem.whitening.transposed(&left.z, rows);
    let length = (rows * PADDING).next_multiple_of(256);
    let mut power = vec![0.0; length / 2];
    for by in by {
        let by = by.evaluate(scene)?;
        let size: f64 = by.iter().map(|x| x * x).sum::<f64>().max(f64::MIN_POSITIVE);
        // What is there all the time is no tone.
        let mean = gradient.iter().zip(&by).map(|(g, x)| g * x).sum::<f64>() / size;
        let away = |(g, x): (&f64, &f64)| Complex::new(g * x - mean * x * x, 0.0);
        let mut spectrum: Vec<Complex<f64>> = gradient.iter().zip(&by).map(away).collect();
        spectrum.resize(length, Complex::ZERO);
        towmag_fourier::scalar::forward(length).process(&mut spectrum);
        power.iter_mut().zip(&spectrum).for_each(|(sum, value)| *sum += value.norm_sqr() / size);
    }
    let hz = |k: usize| k as f64 * RATE_HZ / length as f64;
    let predictor = left.problem.whitening.predictor();
    let size = |k: usize| power[k] / predictor.response(hz(k) / RATE_HZ).max(f64::MIN_POSITIVE);
    let best = (1..length / 2).filter(|&k| hz(k) > LEAST_HZ).max_by(|&a, &b| size(a).total_cmp(&size(b)))?;
    let multiples = (1..=HARMONICS).map(|times| times as f64 * hz(best)).filter(|hz| *hz < 0.5 * RATE_HZ);
    let courses = multiples.flat_map(|hz| [turning(hz, Function::Sin), turning(hz, Function::Cos)]);
    Some(group("time_periodic", form, all_times(courses, by), rows as f64))
}

/// From a moment on; between two rows.
pub(super) fn from(time_s: f64) -> Expr {
    scaled(&var("t"), time_s - 0.5 * EPOCH_S, 0.01 * EPOCH_S).apply(Function::Tanh)
}

/// The jump that fits best.
fn jump(left: &Left<'_>, scene: &Scene, form: DriverForm, by: &[Expr]) -> Option<Group> {
    let end_s = *scene.variable("t")?.last()?;
    let by_columns: Vec<Vec<f64>> = by.iter().map(|by| by.evaluate(scene)).collect::<Option<_>>()?;
    let gain = |time_s: f64| {
        let step = from(time_s).evaluate(scene).unwrap_or_default();
        let raw: Vec<Vec<f64>> =
            by_columns.iter().map(|by| by.iter().zip(&step).map(|(x, step)| x * step).collect()).collect();
        solve(&left.swept(&raw), &left.z).0
    };
    let (mut best_s, mut apart_s) = (0.5 * end_s, end_s / PLACES as f64);
    let inner = PLACES / ENDS..=PLACES - PLACES / ENDS;
    let mut places: Vec<f64> = inner.map(|k| k as f64 * apart_s).collect();
    for _ in 0..ROUNDS {
        best_s = places.iter().copied().max_by(|a, b| gain(*a).total_cmp(&gain(*b)))?;
        let finer_s = apart_s / 6.0;
        places = (-6..=6).map(|k| best_s + f64::from(k) * finer_s).collect();
        apart_s = finer_s;
    }
    let best_s = (best_s * RATE_HZ).round() / RATE_HZ;
    Some(group("time_irregular", form, all_times(std::iter::once(from(best_s)), by), scene.rows() as f64))
}

/// What drifts one way, with one bend: a moment that ages, a clock.
pub(super) fn trends(scene: &Scene) -> [Group; 2] {
    let (middle, width) = scene.variable("t").map_or((0.0, 1.0), middle_and_width);
    let unit = scaled(&var("t"), middle, width.max(EPOCH_S));
    let of = |form, by: &[Expr]| {
        let courses = [unit.clone(), times(&unit, &unit)];
        group("time_irregular", form, all_times(courses.into_iter(), by), 1.0)
    };
    [of(DriverForm::Additive, &["cx", "cy", "cz"].map(var)), of(DriverForm::Delay, &[reading_rate()])]
}

fn slow(scene: &Scene, form: DriverForm, by: &[Expr]) -> Group {
    let end_s = scene.variable("t").and_then(|t| t.last().copied()).unwrap_or(1.0).max(1.0);
    let courses = SLOW.map(|half| turning(0.5 * f64::from(half) / end_s, Function::Cos));
    group("time_irregular", form, all_times(courses, by), 1.0)
}

/// A moment that is another one in each piece of the recording.
fn pieces(scene: &Scene, by: &[Expr]) -> Group {
    let end_s = scene.variable("t").and_then(|t| t.last().copied()).unwrap_or(1.0).max(1.0);
    let count = ((end_s / PIECE_S) as usize).clamp(2, MOST_PIECES);
    let courses = (1..count).map(|k| from(k as f64 * end_s / count as f64));
    group("time_irregular", DriverForm::Additive, all_times(courses, by), 1.0)
}
