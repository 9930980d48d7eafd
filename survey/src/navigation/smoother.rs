//! Positions and velocities from noisy fixes, by a fixed-interval smoother.
//!
//! Each axis is an integrated Wiener process (the velocity wanders) seen through white noise: the smoother of Rauch, Tung
//! and Striebel (1965). How much it wanders against the noise of the fixes is found by maximum likelihood of the
//! innovations (Schweppe 1965), the noise itself being concentrated out: no setting, whatever the receiver.

use super::fix::Fix;

/// A smoothed fix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) time_s: f64,
    pub(crate) place_m: [f64; 2],
    pub(crate) velocity_m_per_s: [f64; 2],
}

/// Spectral density of the acceleration over the variance of a fix, 1/s3, in steps of half a decade: from a body that moves
/// as a ship (1e-4 m2/s3) under a receiver that is off by 10 m, to one in swell (1 m2/s3) fixed to the centimetre. Half a
/// decade changes the bandwidth, which goes with the fourth root, by a third.
const RATIOS: std::ops::RangeInclusive<i32> = -12..=8;
/// Variance of position and velocity before the first fix, over that of a fix: next to nothing is known.
const DIFFUSE: [f64; 2] = [1e10, 1e8];
/// The first two innovations tell where the body is and how fast, not how well that was predicted.
const INITIAL: usize = 2;

/// The two axes have the same covariance: one matrix, two states.
#[derive(Clone, Copy)]
struct State {
    place: [f64; 2],
    velocity: [f64; 2],
    /// Of position, of both, of velocity.
    covariance: [f64; 3],
}

/// The filter's view of a fix: before and after it was seen.
struct Step {
    predicted: State,
    filtered: State,
    step_s: f64,
}

/// What the innovations say of a ratio.
#[derive(Clone, Copy, Default)]
struct Likelihood {
    innovations: usize,
    /// Of squared innovations over their variances.
    squares: f64,
    log_variances: f64,
}

/// Smooth every stretch, with one ratio for all. A stretch of one fix is left out: it has no velocity.
pub(crate) fn smooth(stretches: &[&[Fix]]) -> Vec<Vec<Node>> {
    let stretches: Vec<&[Fix]> = stretches.iter().copied().filter(|stretch| stretch.len() >= 2).collect();
    let mut best = (f64::NEG_INFINITY, 1.0);
    for half_decades in RATIOS {
        let ratio = 10_f64.powf(f64::from(half_decades) / 2.0);
        let mut likelihood = Likelihood::default();
        stretches.iter().for_each(|stretch| likelihood.add(stretch, ratio));
        if likelihood.value() > best.0 {
            best = (likelihood.value(), ratio);
        }
    }
    stretches.iter().map(|stretch| nodes(stretch, best.1)).collect()
}

impl Likelihood {
    fn add(&mut self, stretch: &[Fix], ratio: f64) {
        let mut state = State::unknown();
        let mut time_s = stretch[0].time_s;
        for (at, fix) in stretch.iter().enumerate() {
            state = state.predicted(fix.time_s - time_s, ratio);
            time_s = fix.time_s;
            let variance = state.covariance[0] + 1.0;
            let innovation = state.innovation(fix, stretch);
            if at >= INITIAL {
                self.innovations += 2;
                self.squares += (innovation[0] * innovation[0] + innovation[1] * innovation[1]) / variance;
                self.log_variances += 2.0 * variance.ln();
            }
            state = state.updated(innovation);
        }
    }

    /// Twice the logarithm, but for a constant.
    fn value(&self) -> f64 {
        if self.innovations == 0 || self.squares <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let count = self.innovations as f64;
        -count * (self.squares / count).ln() - self.log_variances
    }
}

impl State {
    /// Relative to the first fix, so that no digits are lost in eastings.
    fn unknown() -> Self {
        Self { place: [0.0; 2], velocity: [0.0; 2], covariance: [DIFFUSE[0], 0.0, DIFFUSE[1]] }
    }

    fn predicted(self, step_s: f64, ratio: f64) -> Self {
        let [p, c, v] = self.covariance;
        let place = std::array::from_fn(|axis| self.place[axis] + step_s * self.velocity[axis]);
        let covariance = [
            p + 2.0 * step_s * c + step_s * step_s * v + ratio * step_s.powi(3) / 3.0,
            c + step_s * v + ratio * step_s * step_s / 2.0,
            v + ratio * step_s,
        ];
        Self { place, covariance, ..self }
    }

    fn innovation(&self, fix: &Fix, stretch: &[Fix]) -> [f64; 2] {
        std::array::from_fn(|axis| fix.place_m[axis] - stretch[0].place_m[axis] - self.place[axis])
    }

    fn updated(self, innovation: [f64; 2]) -> Self {
        let [p, c, v] = self.covariance;
        let gain = [p / (p + 1.0), c / (p + 1.0)];
        Self {
            place: std::array::from_fn(|axis| self.place[axis] + gain[0] * innovation[axis]),
            velocity: std::array::from_fn(|axis| self.velocity[axis] + gain[1] * innovation[axis]),
            covariance: [p / (p + 1.0), c / (p + 1.0), v - gain[1] * c],
        }
    }

    /// The smoothed state of this step from that of the next one.
    fn smoothed(self, next: &Step, next_smoothed: &Self) -> Self {
        let [p, c, v] = self.covariance;
        let [np, nc, nv] = next.predicted.covariance;
        let determinant = np * nv - nc * nc;
        // Covariance of this state with the predicted next one, times the inverse of the latter's own.
        let cross = [[p + next.step_s * c, c], [c + next.step_s * v, v]];
        let gain = cross.map(|[a, b]| [(a * nv - b * nc) / determinant, (b * np - a * nc) / determinant]);
        let change: [[f64; 2]; 2] = [
            std::array::from_fn(|axis| next_smoothed.place[axis] - next.predicted.place[axis]),
            std::array::from_fn(|axis| next_smoothed.velocity[axis] - next.predicted.velocity[axis]),
        ];
        let moved = |row: usize, axis: usize| gain[row][0] * change[0][axis] + gain[row][1] * change[1][axis];
        Self {
            place: std::array::from_fn(|axis| self.place[axis] + moved(0, axis)),
            velocity: std::array::from_fn(|axis| self.velocity[axis] + moved(1, axis)),
            ..self
        }
    }
}

fn nodes(stretch: &[Fix], ratio: f64) -> Vec<Node> {
    let steps = filter(stretch, ratio);
    let mut smoothed: Vec<State> = steps.iter().map(|step| step.filtered).collect();
    for at in (0..steps.len() - 1).rev() {
        smoothed[at] = steps[at].filtered.smoothed(&steps[at + 1], &smoothed[at + 1]);
    }
    let node = |(fix, state): (&Fix, &State)| Node {
        time_s: fix.time_s,
        place_m: std::array::from_fn(|axis| stretch[0].place_m[axis] + state.place[axis]),
        velocity_m_per_s: state.velocity,
    };
    stretch.iter().zip(&smoothed).map(node).collect()
}

fn filter(stretch: &[Fix], ratio: f64) -> Vec<Step> {
    let mut state = State::unknown();
    let mut time_s = stretch[0].time_s;
    let mut steps = Vec::with_capacity(stretch.len());
    for fix in stretch {
        let step_s = fix.time_s - std::mem::replace(&mut time_s, fix.time_s);
        let predicted = state.predicted(step_s, ratio);
        state = predicted.updated(predicted.innovation(fix, stretch));
        steps.push(Step { predicted, filtered: state, step_s });
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// A leg, a half circle of 60 m and the leg back at 2 m/s, every second; noise of 1 m.
    fn tow() -> (Vec<Fix>, Vec<[f64; 2]>) {
        let turn_s = std::f64::consts::PI * 60.0 / 2.0;
        let truth = |t: f64| match t {
            t if t < 300.0 => [0.0, 2.0 * t],
            t if t < 300.0 + turn_s => {
                let angle = (t - 300.0) * 2.0 / 60.0;
                [60.0 - 60.0 * angle.cos(), 600.0 + 60.0 * angle.sin()]
            }
            t => [120.0, 600.0 - 2.0 * (t - 300.0 - turn_s)],
        };
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let times = (0..700).map(f64::from);
        let truths: Vec<[f64; 2]> = times.clone().map(truth).collect();
        let fix = |(time_s, place): (f64, &[f64; 2])| {
            let place_m = [place[0] + 500_000.0 + noise(), place[1] + 6_000_000.0 + noise()];
            Fix { time_s, place_m }
        };
        (times.zip(&truths).map(fix).collect(), truths)
    }

    #[test]
    fn it_is_better_than_the_fixes_and_knows_the_speed() {
        let (fixes, truth) = tow();
        let nodes = smooth(&[&fixes]).remove(0);
        let squares: f64 = nodes
            .iter()
            .zip(&truth)
            .map(|(node, truth)| {
                let off = [node.place_m[0] - 500_000.0 - truth[0], node.place_m[1] - 6_000_000.0 - truth[1]];
                (off[0] * off[0] + off[1] * off[1]) / 2.0
            })
            .sum();
        let rms_m = (squares / truth.len() as f64).sqrt();
        assert!(rms_m < 0.5, "{rms_m}");
        let speeds = nodes[20..680].iter().map(|node| node.velocity_m_per_s[0].hypot(node.velocity_m_per_s[1]));
        assert!(speeds.clone().all(|speed| (speed - 2.0).abs() < 0.4), "{:?}", speeds.collect::<Vec<_>>());
    }

    #[test]
    fn fixes_without_noise_stay_where_they_are() {
        let fixes: Vec<Fix> =
            (0..50).map(|s| Fix { time_s: f64::from(s), place_m: [f64::from(s) * 1.5, -f64::from(s)] }).collect();
        for (node, fix) in smooth(&[&fixes])[0].iter().zip(&fixes) {
            let off = (node.place_m[0] - fix.place_m[0]).hypot(node.place_m[1] - fix.place_m[1]);
            assert!(off < 1e-3 && (node.velocity_m_per_s[0] - 1.5).abs() < 1e-3, "{node:?}");
        }
    }
}
