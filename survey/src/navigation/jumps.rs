//! What a receiver does that no body can: it jumps, hangs and catches up, or is beside the way for a while.
//!
//! A jump is where a line through the fixes before and a line through those after do not meet.

use super::fix::{Fix, limit_m};

/// What a receiver did, times in seconds as recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReceiverFault {
    /// It told the same place until it caught up. These fixes are not used.
    Hang {
        /// From here on.
        from_s: f64,
        /// Until then.
        to_s: f64,
    },
    /// It was beside the way for a while. These fixes are not used.
    Away {
        /// From here on.
        from_s: f64,
        /// Until then.
        to_s: f64,
        /// How far, m.
        by_m: f64,
    },
    /// It jumped and did not come back: which of both sides is right is not known, and both are used.
    Step {
        /// When.
        at_s: f64,
        /// How far, m.
        by_m: f64,
    },
}

/// The lines go through the fixes of so long, s: a ship that turns in 10 s at 2 m/s is 0.9 m beside them.
const LINE_S: f64 = 3.0;
/// And through so many at least: two have no noise.
const LEAST_FIXES: usize = 3;
/// Over a longer time without fixes nothing is said, s.
const LONGEST_GAP_S: f64 = 10.0;
/// In the middle of a gap of T both lines together may be off by this times T^2, m/s2: a turn at 0.2 m/s2, a quarter of it.
const BENT_M_PER_S2: f64 = 0.05;
/// A receiver hangs if it stood before the jump for longer, s,
const HANG_S: f64 = 3.0;
/// within this share of the jump,
const STANDS: f64 = 0.1;
/// and a body that is this fast afterwards, m/s,
const MOVES_M_PER_S: f64 = 0.3;
/// would have come at least a third so far in that time.
const CATCHES_UP: f64 = 3.0;
/// A receiver that comes back does so within this, s,
const LONGEST_AWAY_S: f64 = 300.0;
/// which is less than this share of the recording,
const MOST_AWAY: f64 = 0.25;
/// and to this share of the jump.
const BACK: f64 = 0.5;

#[derive(Clone, Copy)]
struct Jump {
    /// Index of the first fix after it.
    at: usize,
    by_m: [f64; 2],
    /// Above what noise and turns make, as a multiple of it.
    ratio: f64,
}

impl Jump {
    fn size_m(&self) -> f64 {
        self.by_m[0].hypot(self.by_m[1])
    }
}

/// The fixes between steps, without those of a receiver that hung or was away, and what it did.
pub(super) fn between_jumps(fixes: &[Fix]) -> (Vec<Vec<Fix>>, Vec<ReceiverFault>) {
    let mut is_used = vec![true; fixes.len()];
    let (mut faults, mut left, mut steps) = (Vec::new(), Vec::new(), Vec::new());
    for jump in jumps(fixes) {
        match hung_since(fixes, &jump) {
            Some(since) => {
                is_used[since + 1..jump.at].fill(false);
                faults.push(ReceiverFault::Hang { from_s: fixes[since].time_s, to_s: fixes[jump.at].time_s });
            }
            None => left.push(jump),
        }
    }
    let mut next = left.as_slice();
    while let [jump, rest @ ..] = next {
        let (at_s, by_m) = (fixes[jump.at].time_s, jump.size_m());
        next = rest;
        match rest.first().filter(|back| is_back(fixes, jump, back)) {
            Some(back) => {
                is_used[jump.at..back.at].fill(false);
                faults.push(ReceiverFault::Away { from_s: at_s, to_s: fixes[back.at].time_s, by_m });
                next = &rest[1..];
            }
            None => {
                steps.push(jump.at);
                faults.push(ReceiverFault::Step { at_s, by_m });
            }
        }
    }
    let ends = steps.iter().copied().chain([fixes.len()]);
    let stretches = [0]
        .into_iter()
        .chain(steps.iter().copied())
        .zip(ends)
        .map(|(from, to)| (from..to).filter(|&at| is_used[at]).map(|at| fixes[at]).collect());
    (stretches.collect(), faults)
}

/// All jumps, in the order of time: where the lines are furthest apart.
fn jumps(fixes: &[Fix]) -> Vec<Jump> {
    let apart: Vec<Option<[f64; 2]>> = (0..fixes.len()).map(|at| apart_m(fixes, at)).collect();
    let mut sizes: Vec<f64> = apart.iter().flatten().map(|[x, y]| x.hypot(*y)).collect();
    let least_m = limit_m(&mut sizes);
    let jump = |(at, by_m): (usize, &Option<[f64; 2]>)| {
        let (by_m, gap_s) = ((*by_m)?, fixes[at].time_s - fixes[at - 1].time_s);
        let limit_m = least_m + BENT_M_PER_S2 * gap_s * gap_s;
        let ratio = by_m[0].hypot(by_m[1]) / limit_m;
        (ratio > 1.0).then_some(Jump { at, by_m, ratio })
    };
    let mut found: Vec<Jump> = apart.iter().enumerate().filter_map(jump).collect();
    found.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
    let mut largest: Vec<Jump> = Vec::new();
    for jump in found {
        // The lines over a jump are wrong beside it too.
        let is_beside = |other: &Jump| (fixes[other.at].time_s - fixes[jump.at].time_s).abs() <= LINE_S;
        if !largest.iter().any(is_beside) {
            largest.push(jump);
        }
    }
    largest.sort_by_key(|jump| jump.at);
    largest
}

/// From the line through the fixes before this one to that through those from it on, in the middle between both, m.
fn apart_m(fixes: &[Fix], at: usize) -> Option<[f64; 2]> {
    let [before, after] = about(fixes, at)?;
    let middle_s = (before[before.len() - 1].time_s + after[0].time_s) / 2.0;
    let ([from, _], [to, _]) = (line(before, middle_s), line(after, middle_s));
    Some([to[0] - from[0], to[1] - from[1]])
}

/// The fixes of [`LINE_S`] before this one, and from it on; `None` where there are too few.
fn about(fixes: &[Fix], at: usize) -> Option<[&[Fix]; 2]> {
    let last_s = fixes[at.checked_sub(1)?].time_s;
    let first_s = fixes[at].time_s;
    let start = fixes[..at].partition_point(|fix| fix.time_s < last_s - LINE_S);
    let end = at + fixes[at..].partition_point(|fix| fix.time_s <= first_s + LINE_S);
    let sides = [&fixes[start..at], &fixes[at..end]];
    (first_s - last_s <= LONGEST_GAP_S && sides.iter().all(|side| side.len() >= LEAST_FIXES)).then_some(sides)
}

/// Place at a time, and velocity, of the line of least squares through fixes.
fn line(fixes: &[Fix], at_s: f64) -> [[f64; 2]; 2] {
    let count = fixes.len() as f64;
    let mean = |of: &dyn Fn(&Fix) -> f64| fixes.iter().map(of).sum::<f64>() / count;
    let mean_s = mean(&|fix| fix.time_s - at_s);
    // About the first fix: sums of northings would lose digits.
    let of_axis = |axis: usize| {
        let first = fixes[0].place_m[axis];
        let mean_m = mean(&|fix| fix.place_m[axis] - first);
        let covariance = mean(&|fix| (fix.time_s - at_s - mean_s) * (fix.place_m[axis] - first - mean_m));
        let velocity = covariance / mean(&|fix| (fix.time_s - at_s - mean_s).powi(2)).max(f64::MIN_POSITIVE);
        [first + mean_m - velocity * mean_s, velocity]
    };
    let [x, y] = [of_axis(0), of_axis(1)];
    [[x[0], y[0]], [x[1], y[1]]]
}

/// The last fix that was right before the receiver hung, if it did before this jump.
fn hung_since(fixes: &[Fix], jump: &Jump) -> Option<usize> {
    let last = fixes[jump.at - 1];
    let is_there = |fix: &&Fix| {
        (fix.place_m[0] - last.place_m[0]).hypot(fix.place_m[1] - last.place_m[1]) <= STANDS * jump.size_m()
    };
    let since = jump.at - fixes[..jump.at].iter().rev().take_while(is_there).count();
    let stood_s = last.time_s - fixes[since].time_s;
    let [_, after] = about(fixes, jump.at)?;
    let [_, [east, north]] = line(after, after[0].time_s);
    let speed = east.hypot(north);
    let is_hang = stood_s >= HANG_S && speed > MOVES_M_PER_S && jump.size_m() <= CATCHES_UP * speed * stood_s;
    is_hang.then_some(since)
}

fn is_back(fixes: &[Fix], jump: &Jump, back: &Jump) -> bool {
    let away_s = fixes[back.at].time_s - fixes[jump.at].time_s;
    let whole_s = fixes[fixes.len() - 1].time_s - fixes[0].time_s;
    let off_m = (jump.by_m[0] + back.by_m[0]).hypot(jump.by_m[1] + back.by_m[1]);
    away_s <= LONGEST_AWAY_S.min(MOST_AWAY * whole_s) && off_m <= BACK * jump.size_m()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Ten minutes at 2 m/s with turns of 8 m radius, fixes every `step_s` off by up to `noise_m`.
    fn tow(step_s: f64, noise_m: f64) -> Vec<Fix> {
        let (leg_s, turn_s, radius_m) = (60.0, 8.0 * PI / 2.0, 8.0);
        let mut way = (0.0, 0.0, 0.0_f64);
        let mut fixes = Vec::new();
        let mut random = 1_u32;
        let mut noise = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            noise_m * (f64::from(random) / f64::from(u32::MAX) * 2.0 - 1.0)
        };
        let steps = (600.0 / 0.1) as usize;
        for k in 0..steps {
            let time_s = k as f64 * 0.1;
            if (time_s / step_s).fract() < 0.05 || (time_s / step_s).fract() > 0.99 {
                fixes.push(Fix { time_s, place_m: [500_000.0 + way.0 + noise(), 6_000_000.0 + way.1 + noise()] });
            }
            if time_s % (leg_s + turn_s) > leg_s {
                way.2 += 0.1 * 2.0 / radius_m;
            }
            way.0 += 0.2 * way.2.sin();
            way.1 += 0.2 * way.2.cos();
        }
        fixes
    }

    #[test]
    fn a_tow_that_turns_has_none() {
        for (step_s, noise_m) in [(0.1, 0.02), (0.1, 0.5), (1.0, 0.0), (1.0, 1.0), (0.2, 0.0)] {
            let fixes = tow(step_s, noise_m);
            let (stretches, faults) = between_jumps(&fixes);
            assert!(faults.is_empty(), "{step_s} {noise_m}: {faults:?}");
            assert_eq!(stretches, [fixes]);
        }
    }

    #[test]
    fn who_is_away_or_hangs_is_left_out() {
        for (step_s, noise_m) in [(0.1, 0.02), (1.0, 0.05)] {
            let mut fixes = tow(step_s, noise_m);
            fixes.iter_mut().filter(|fix| (200.0..260.0).contains(&fix.time_s)).for_each(|fix| fix.place_m[1] += 9.0);
            let stands = fixes[(400.0 / step_s) as usize].place_m;
            for (k, fix) in fixes.iter_mut().enumerate().filter(|(_, fix)| (400.0..460.0).contains(&fix.time_s)) {
                fix.place_m = [stands[0] + 0.002 * (k % 3) as f64, stands[1]];
            }
            let (stretches, faults) = between_jumps(&fixes);
            let [ReceiverFault::Hang { from_s, to_s }, ReceiverFault::Away { from_s: away_s, to_s: back_s, by_m }] =
                faults[..]
            else {
                panic!("{faults:?}")
            };
            assert!((from_s - 400.0).abs() < 6.0 && (to_s - 460.0).abs() <= step_s, "{from_s} {to_s}");
            assert!((away_s - 200.0).abs() <= step_s && (back_s - 260.0).abs() <= step_s && (by_m - 9.0).abs() < 1.5);
            let used =
                |from_s: f64, to_s: f64| stretches[0].iter().filter(|fix| (from_s..to_s).contains(&fix.time_s)).count();
            assert_eq!((stretches.len(), used(202.0, 258.0), used(407.0, 458.0)), (1, 0, 0));
            assert_eq!(used(300.0, 390.0), (90.0 / step_s).round() as usize);
        }
    }

    #[test]
    fn a_step_stays_and_is_told() {
        let mut fixes = tow(1.0, 0.3);
        fixes.iter_mut().filter(|fix| fix.time_s >= 330.0).for_each(|fix| fix.place_m[0] += 7.0);
        let (stretches, faults) = between_jumps(&fixes);
        let [ReceiverFault::Step { at_s, by_m }] = faults[..] else { panic!("{faults:?}") };
        assert!((at_s - 330.0).abs() <= 1.0 && (by_m - 7.0).abs() < 2.0, "{at_s} {by_m}");
        assert_eq!(stretches.iter().map(Vec::len).sum::<usize>(), fixes.len());
        assert_eq!(stretches.len(), 2);
    }
}
