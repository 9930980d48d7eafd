//! What moves a step at each of some events: whenever the body goes over to one side, a bolt turns, ballast settles elsewhere, a plate finds
//! another seat. Its moment stays as it is in between, and is another one after each; how it moves, no shape of the attitude tells.

use statrs::statistics::Statistics;

use super::edges::Drive;
use super::left::Left;
use super::time::from;
use crate::diagnosis::numerics::cumulative_sums;
use crate::diagnosis::policy::{EPOCH_S, STEPS_BEYOND_CHANCE};
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{times, var};
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs::AXES;
use crate::diagnosis::shapes::ridge::turned;
use crate::diagnosis::shapes::scene::Scene;

/// How far the body goes over, over the spread of a direction.
const EDGES: [f64; 4] = [0.7, 0.95, 1.2, 1.45];
/// Events that say anything together, and that a fit can hold.
const EVENTS: std::ops::RangeInclusive<usize> = 5..=80;
/// Rows before and after an event that tell how far something moved.
const ABOUT_ROWS: usize = 8;
/// Kinds of events of which the steps are fitted, those first at which most moves.
const MOST_FITTED: usize = 6;
/// Turns in time that tell how much moves by chance at the best kind.
const TURNS: usize = 40;

/// The kinds of events at which what is left moves most, each as a group; only the best of them counts.
pub(super) fn groups(left: &Left<'_>, drives: &[Drive], scene: &Scene) -> Vec<Group> {
    let moved = moved(left.robust_nt());
    let elsewhere = Elsewhere::of(&moved);
    let kinds = kinds(drives, scene);
    let tried = kinds.len().max(1) as f64;
    let least = elsewhere.by_chance(&moved, &kinds);
    let mut by_move: Vec<(f64, Vec<usize>)> =
        kinds.into_iter().map(|events| (elsewhere.beaten_by(&moved, &events), events)).collect();
    by_move.retain(|(beaten_by, _)| *beaten_by > least);
    by_move.sort_by(|a, b| b.0.total_cmp(&a.0));
    by_move.into_iter().take(MOST_FITTED).map(|(_, events)| group(&events, tried)).collect()
}

/// The rows of every kind of event: the body goes over to one side, by so much, along some direction.
fn kinds(drives: &[Drive], scene: &Scene) -> Vec<Vec<usize>> {
    let of = |(values, (middle, width)): (Vec<f64>, (f64, f64))| {
        let sides = [1.0, -1.0].map(|side| values.iter().map(|x| side * (x - middle) / width).collect::<Vec<f64>>());
        sides.into_iter().flat_map(|over| EDGES.map(|edge| events(&over, edge)))
    };
    let attitude = drives.iter().filter(|drive| drive.input == "attitude");
    let courses = attitude.filter_map(|drive| Some((drive.of.evaluate(scene)?, drive.at)));
    courses.flat_map(of).filter(|events| EVENTS.contains(&events.len())).collect()
}

/// Rows at which a course goes beyond an edge, after it was below its middle.
fn events(over: &[f64], edge: f64) -> Vec<usize> {
    let mut is_armed = true;
    let mut events = Vec::new();
    for (row, x) in over.iter().enumerate() {
        if *x > edge && is_armed {
            events.push(row);
            is_armed = false;
        }
        is_armed |= *x < 0.0;
    }
    events
}

/// A moment that is another one after each event.
fn group(events: &[usize], tried: f64) -> Group {
    let steps = events.iter().map(|&row| from(row as f64 * EPOCH_S));
    let shapes = steps.flat_map(|step| AXES.map(|axis| times(&var(axis), &step))).collect();
    let (input, form) = ("attitude_history".into(), DriverForm::Additive);
    Group { input, form, shapes, over: var("t"), tried, without_input: 0 }
}

/// Square of how far a course is after a row from where it was before it, nT^2; none where too few rows are used.
fn moved(course_nt: &[Option<f64>]) -> Vec<Option<f64>> {
    let sums = cumulative_sums(course_nt.iter().map(|nt| nt.unwrap_or(0.0)));
    let counts = cumulative_sums(course_nt.iter().map(|nt| f64::from(u8::from(nt.is_some()))));
    let mean = |from: usize, to: usize| {
        let count = counts[to] - counts[from];
        (count >= 0.5 * ABOUT_ROWS as f64).then(|| (sums[to] - sums[from]) / count)
    };
    let of = |row: usize| {
        let (from, to) = (row.saturating_sub(ABOUT_ROWS), (row + ABOUT_ROWS).min(course_nt.len()));
        Some((mean(row, to)? - mean(from, row)?).powi(2))
    };
    (0..course_nt.len()).map(of).collect()
}

/// How far it moves at all rows alike.
struct Elsewhere {
    mean: f64,
    spread: f64,
}

impl Elsewhere {
    fn of(moved: &[Option<f64>]) -> Self {
        let all: Vec<f64> = moved.iter().flatten().copied().collect();
        Self { mean: (&all).mean(), spread: (&all).population_std_dev() }
    }

    /// Standard errors by which it moves more at the events.
    fn beaten_by(&self, moved: &[Option<f64>], events: &[usize]) -> f64 {
        let own: Vec<f64> = events.iter().filter_map(|&row| moved[row]).collect();
        if own.len() < *EVENTS.start() {
            return f64::NEG_INFINITY;
        }
        let error = self.spread / (own.len() as f64).sqrt();
        ((&own).mean() - self.mean) / error.max(f64::MIN_POSITIVE)
    }

    /// By how much the best of many kinds beats it by chance, at most: where something moves now and then, whatever the body does, some
    /// kind meets it. Of the course turned round in time.
    fn by_chance(&self, moved: &[Option<f64>], kinds: &[Vec<usize>]) -> f64 {
        let of_turn = |turn: usize| {
            let turned = turned(moved, turn, TURNS);
            kinds.iter().map(|events| self.beaten_by(&turned, events)).fold(f64::NEG_INFINITY, f64::max)
        };
        let best: Vec<f64> = (1..=TURNS).map(of_turn).filter(|best| best.is_finite()).collect();
        if best.is_empty() {
            return f64::INFINITY;
        }
        (&best).mean() + STEPS_BEYOND_CHANCE * (&best).population_std_dev()
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn a_body_goes_over_once_until_it_was_on_the_other_side() {
        assert_eq!(events(&[0.0, 2.0, 0.5, 2.0, -0.1, 2.0], 1.0), [1, 5]);
    }

    #[test]
    fn what_jumps_at_the_events_moves_more_there_than_elsewhere() {
        let events: Vec<usize> = (1..10).map(|k| 50 * k).collect();
        let noise = |row: usize| 0.3 * (row as f64 * 1.7).sin();
        let course: Vec<Option<f64>> = (0..500).map(|row| Some((row / 50 % 2) as f64 + noise(row))).collect();
        let moved = moved(&course);
        let elsewhere = Elsewhere::of(&moved);
        let beside: Vec<usize> = events.iter().map(|row| row - 25).collect();
        assert!(elsewhere.beaten_by(&moved, &events) > 6.0);
        assert!(elsewhere.beaten_by(&moved, &beside) < 0.0);
        assert_eq!(elsewhere.beaten_by(&moved, &events[..3]), f64::NEG_INFINITY);
    }

    #[test]
    fn of_many_kinds_one_meets_what_switches_by_itself_and_that_is_chance() {
        let is_beyond = |moved: &[Option<f64>], kinds: &[Vec<usize>]| {
            let elsewhere = Elsewhere::of(moved);
            let least = elsewhere.by_chance(moved, kinds);
            kinds.iter().any(|events| elsewhere.beaten_by(moved, events) > least)
        };
        let mut met = [0, 0];
        for seed in 0..10 {
            let random = &mut ChaCha8Rng::seed_from_u64(seed);
            let mut rows = || {
                let mut rows: Vec<usize> = (0..20).map(|_| random.random_range(20..1980)).collect();
                rows.sort_unstable();
                rows
            };
            let switched = rows();
            let is_on = |row: usize| (switched.partition_point(|at| *at <= row) % 2) as f64;
            let course: Vec<Option<f64>> =
                (0..2000).map(|row| Some(is_on(row) + 0.2 * (row as f64 * 1.7).sin())).collect();
            let mut kinds: Vec<Vec<usize>> = (0..100).map(|_| rows()).collect();
            let moved = moved(&course);
            met[0] += u8::from(is_beyond(&moved, &kinds));
            kinds.push(switched.clone());
            met[1] += u8::from(is_beyond(&moved, &kinds));
        }
        assert!(met[0] <= 3 && met[1] == 10, "{met:?}");
    }
}
