//! What remembers with edges: relays of two thresholds, on the direction along some axes and on how fast the body turns (Preisach's
//! element), and what stays as it is until it jumps. The few relays that fit best make a group, which pays for all that were tried.

use rayon::prelude::*;

use super::left::Left;
use crate::diagnosis::policy::EDGES_LEAST_GAIN;
use crate::diagnosis::regression::problem::solve;
use crate::diagnosis::regression::products::dot;
use crate::diagnosis::result::DriverForm;
use crate::diagnosis::shapes::expression::{Expr, Function, scaled, var};
use crate::diagnosis::shapes::filter::Filter;
use crate::diagnosis::shapes::group::Group;
use crate::diagnosis::shapes::inputs::{along_field, fast, tilts, turns};
use crate::diagnosis::shapes::ridge::turned;
use crate::diagnosis::shapes::scene::{Scene, knots, middle_and_width};

/// Half widths of a relay, over the spread of what drives it; 0 is a plain threshold, which remembers nothing.
const WIDTHS: [f64; 4] = [0.0, 0.3, 0.7, 1.2];
/// Middles of a relay: so many quantiles of what its play leaves.
const MIDDLES: usize = 5;
/// Relays that one thing may have.
const MOST_RELAYS: usize = 4;
/// Candidates that are tried beside those that were chosen.
const MOST_CANDIDATES: usize = 24;
/// Steps of width and middle, over the spread, with which a chosen relay is moved.
const STEPS: [f64; 3] = [0.15, 0.07, 0.03];
/// Ways in which a relay is moved: by a step of its width, its middle, or both.
const MOVES: [(f64, f64); 8] =
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
/// Share of what was taken before that one more relay must take.
const LEAST_MORE: f64 = 0.03;
/// Turns of the residual in time that say what the best of all relays takes by chance.
const TURNS: usize = 6;
/// Distances at which something jumps after what it sticks to, over the spread.
const HOLDS: [f64; 4] = [0.4, 0.8, 1.2, 1.8];

/// One threshold on the way up, one on the way down.
#[derive(Clone)]
struct Relay {
    drive: usize,
    width: f64,
    middle: f64,
}

/// A relay with its columns, everything fitted projected out: that takes longer than all that is done with them.
#[derive(Clone)]
struct Seen {
    relay: Relay,
    columns: Vec<Vec<f64>>,
}

/// What may throw a relay, without its memory.
pub(super) struct Drive {
    pub(super) input: &'static str,
    pub(super) of: Expr,
    /// Its middle and spread.
    pub(super) at: (f64, f64),
}

/// Groups of relays on the attitude, its history and its rate, and of what sticks and jumps.
pub(super) fn groups(left: &Left<'_>, drives: &[Drive], scene: &Scene) -> Vec<Vec<Group>> {
    let search = Search { left, scene, drives };
    let (single, by_chance) = search.singles();
    let of = |input: &'static str, remembers: bool| {
        let own = single.iter().filter(|(relay, _)| search.input(relay) == input && (relay.width > 0.0) >= remembers);
        search.group(input, &own.cloned().collect::<Vec<_>>(), single.len(), by_chance)
    };
    let relays = [of("attitude", false), of("attitude_history", true), of("attitude_rate", false)];
    let mut all: Vec<Vec<Group>> = relays.into_iter().flatten().map(|group| vec![group]).collect();
    all.push(vec![holds(drives)]);
    all
}

/// The direction along some axes and the tilt, as it is and without what is slow of it, and how fast the body turns.
pub(super) fn drives(scene: &Scene) -> Vec<Drive> {
    let axes = ["cx", "cy", "cz"].map(var);
    let diagonal = |i: usize, j: usize, sign: f64| {
        Expr::Sum(vec![axes[i].clone(), Expr::Product(vec![Expr::Number(sign), axes[j].clone()])])
    };
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let diagonals = pairs.into_iter().flat_map(|(i, j)| [diagonal(i, j, 1.0), diagonal(i, j, -1.0)]);
    let still: Vec<Expr> = axes.iter().cloned().chain(diagonals).chain(tilts(scene)).collect();
    let moving: Vec<Expr> = still.iter().map(fast).collect();
    let of = |input: &'static str, of: Expr| {
        let at = middle_and_width(&of.evaluate(scene)?);
        (at.1 > 0.0).then_some(Drive { input, of, at })
    };
    let attitude = still.into_iter().chain(moving).filter_map(|expr| of("attitude", expr));
    attitude.chain(turns(scene).into_iter().filter_map(|expr| of("attitude_rate", expr))).collect()
}

struct Search<'b, 'a> {
    left: &'b Left<'a>,
    scene: &'b Scene,
    drives: &'b [Drive],
}

impl Search<'_, '_> {
    /// What a relay remembers of the attitude is its history.
    fn input(&self, relay: &Relay) -> &'static str {
        match self.drives[relay.drive].input {
            "attitude" if relay.width > 0.0 => "attitude_history",
            other => other,
        }
    }

    fn play(&self, relay: &Relay) -> Expr {
        let drive = &self.drives[relay.drive];
        match relay.width > 0.0 {
            true => drive.of.through(Filter::Play(relay.width * drive.at.1)),
            false => drive.of.clone(),
        }
    }

    /// A relay is the sign of what follows with play, less its middle.
    fn shape(&self, relay: &Relay) -> Expr {
        let at = self.drives[relay.drive].at;
        scaled(&self.play(relay), at.0 + relay.middle * at.1, 1.0).apply(Function::Sign)
    }

    /// A relay as the residual would show it, alone and as a moment.
    fn seen(&self, relay: Relay) -> Seen {
        let shapes = along_field(&[self.shape(&relay)]);
        let columns: Vec<Vec<f64>> = shapes.iter().filter_map(|shape| shape.evaluate(self.scene)).collect();
        Seen { columns: self.left.swept(&columns), relay }
    }

    /// What some relays and one more take of the residual together.
    fn taken(&self, chosen: &[Seen], more: &Seen) -> f64 {
        let columns: Vec<&[f64]> =
            chosen.iter().chain([more]).flat_map(|seen| &seen.columns).map(Vec::as_slice).collect();
        solve(&columns, &self.left.z).0
    }

    /// Every relay that is tried at first, with what it takes of the residual, alone and as a moment; and the most that any of them takes
    /// of the residual turned round in time.
    fn singles(&self) -> (Vec<(Relay, f64)>, f64) {
        let tried = (0..self.drives.len()).flat_map(|drive| WIDTHS.map(|width| (drive, width)));
        let of = |(drive, width): (usize, f64)| -> Vec<Relay> {
            let at = self.drives[drive].at;
            let play = self.play(&Relay { drive, width, middle: 0.0 });
            let middles = knots(&play.evaluate(self.scene).unwrap_or_default(), MIDDLES);
            middles.into_iter().map(|middle| Relay { drive, width, middle: (middle - at.0) / at.1 }).collect()
        };
        let relays: Vec<Relay> = tried.flat_map(of).collect();
        let turned: Vec<Vec<f64>> = (1..=TURNS).map(|turn| turned(&self.left.z, turn, TURNS)).collect();
        let judge = |relay: Relay| {
            let seen = self.seen(relay);
            let by_chance = turned.iter().map(|z| solve(&seen.columns, z).0).fold(0.0, f64::max);
            let taken = self.taken(&[], &seen);
            ((seen.relay, taken), by_chance)
        };
        let (mut all, chances): (Vec<(Relay, f64)>, Vec<f64>) = relays.into_par_iter().map(judge).unzip();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        (all, chances.into_iter().fold(0.0, f64::max))
    }

    /// The relays that fit best one after the other, each moved to where it fits best; none where the first one does not pay. Each must take
    /// more than the best of all would by chance of what was left before it.
    fn group(&self, input: &str, singles: &[(Relay, f64)], tried: usize, by_chance: f64) -> Option<Group> {
        let whole = dot(&self.left.z, &self.left.z).max(f64::MIN_POSITIVE);
        let candidates: Vec<Seen> =
            singles.par_iter().take(MOST_CANDIDATES).map(|(relay, _)| self.seen(relay.clone())).collect();
        let mut chosen: Vec<Seen> = Vec::new();
        let mut taken = 0.0;
        for _ in 0..MOST_RELAYS {
            let beside = candidates.par_iter().map(|candidate| (self.taken(&chosen, candidate), candidate));
            let (with, best) = beside.max_by(|a, b| a.0.total_cmp(&b.0))?;
            let (with, moved) = self.moved(&chosen, best.clone(), with);
            let least = EDGES_LEAST_GAIN * self.left.variance + LEAST_MORE * taken;
            if with - taken < least.max(by_chance * (1.0 - taken / whole)) {
                break;
            }
            taken = with;
            chosen.push(moved);
        }
        let chosen: Vec<Relay> = chosen.into_iter().map(|seen| seen.relay).collect();
        let first = chosen.first()?;
        let over = self.drives[first.drive].of.clone();
        let shapes = along_field(&chosen.iter().map(|relay| self.shape(relay)).collect::<Vec<_>>());
        // Widths and middles are places, of which each relay tries all anew.
        let tried = (tried as f64 * (STEPS.len() * MOVES.len()) as f64).powi(chosen.len() as i32);
        Some(Group { input: input.into(), form: DriverForm::Additive, shapes, over, tried, without_input: 0 })
    }

    /// A relay where it fits best beside those that are chosen, with what all take.
    fn moved(&self, chosen: &[Seen], mut best: Seen, mut taken: f64) -> (f64, Seen) {
        for step in STEPS {
            let from = &best.relay;
            let moves = MOVES.par_iter().filter_map(|(width, middle)| {
                // What remembers nothing stays so, and the reverse: it is another input.
                let width = if from.width > 0.0 { from.width + width * step } else { 0.0 };
                let is_same_input = (width > 0.0) == (from.width > 0.0);
                is_same_input.then(|| {
                    let other = self.seen(Relay { width, middle: from.middle + middle * step, ..*from });
                    (self.taken(chosen, &other), other)
                })
            });
            if let Some((more, other)) = moves.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(more, _)| *more > taken) {
                (taken, best) = (more, other);
            }
        }
        (taken, best)
    }
}

/// What sticks to the direction as it was, and jumps after it.
fn holds(drives: &[Drive]) -> Group {
    let axes = drives.iter().filter(|drive| drive.input == "attitude");
    let held = axes.flat_map(|drive| {
        HOLDS.map(|of| scaled(&drive.of.through(Filter::Hold(of * drive.at.1)), drive.at.0, drive.at.1))
    });
    let shapes = held.collect();
    let (input, form) = ("attitude_history".into(), DriverForm::Additive);
    Group { input, form, shapes, over: var("cx"), tried: 1.0, without_input: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_of_what_follows_with_play_is_a_relay_of_two_thresholds() {
        let course: Vec<f64> =
            (0..600).map(|row| (0.07 * f64::from(row)).sin() + 0.4 * (0.31 * f64::from(row)).sin()).collect();
        let (middle, width) = (0.2, 0.5);
        let mut is_on = false;
        // After a gap both begin where the course is.
        let thrown = |(row, x): (usize, &f64)| {
            is_on = match row {
                0 | 300 => *x >= middle,
                _ if is_on => *x > middle - width,
                _ => *x >= middle + width,
            };
            if is_on { 1.0 } else { -1.0 }
        };
        let relay: Vec<f64> = course.iter().enumerate().map(thrown).collect();
        let scene = Scene::with([("cx", course)], vec![0..300, 300..600]);
        let shape = scaled(&var("cx").through(Filter::Play(width)), middle, 1.0).apply(Function::Sign);
        assert_eq!(shape.evaluate(&scene).unwrap(), relay);
        assert_eq!(shape.to_string().matches("signum").count(), 1);
    }
}
