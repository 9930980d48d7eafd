//! The adaptive method in f64, straight from `docs/adaptive.md`: normal equations in the units of eq. (4), no square
//! roots.

use super::{Matrix, Vector, solve};
use towmag::model::NT_PER_UNIT;

const INFORMATION_SHARES: [f64; 6] = [1.0, 0.1, 0.01, 1e-6, 0.0, 1e-6];
const PRIOR_COST_NATS: [f64; 6] = [0.0, 1.0, 2.0, 8.0, 10.0, 13.0];
const FORGETTING_MULTIPLIERS: [f64; 6] = [1.0, 1.0, 1.0, 1.0, 5.0, 1.0];
const GATES: [f64; 6] = [1.45, 1.45, 1.45, 1.45, 1.45, 2.5];
/// Which learns from rows as they are.
const PLAIN: usize = 5;

/// `exp(-1 / (0.45 s 10 Hz))`.
const RHO: f64 = 0.800_737_402_916_808;
/// Mean of `|1 - rho exp(-i w)|^2` from 0.1 to 0.9 Hz at 10 Hz.
fn gain() -> f64 {
    let (low, high) = (0.02 * std::f64::consts::PI, 0.18 * std::f64::consts::PI);
    1.0 + RHO * RHO - 2.0 * RHO * (high.sin() - low.sin()) / (high - low)
}

/// `1e-10` for each coefficient in nT.
fn no_information() -> Matrix {
    Matrix::from_diagonal(&Vector::from_fn(|i, _| 1e-10 * NT_PER_UNIT[i] * NT_PER_UNIT[i]))
}

struct Member {
    information: Matrix,
    right: Vector,
    beta: Vector,
    aged: [Vector; 2],
    noise: f64,
    aged_noise: f64,
    log_evidence: f64,
    age: u32,
}

impl Member {
    fn new(information: Matrix, beta: Vector, noise: f64, aged_noise: f64, log_evidence: f64) -> Self {
        let information = information + no_information();
        let right = information * beta;
        Self { information, right, beta, aged: [beta; 2], noise, aged_noise, log_evidence, age: 0 }
    }
}

/// The bank.
pub struct Adaptive {
    pub beta: Vector,
    members: Vec<Member>,
    before: (Vector, f64),
    epochs: u32,
    failures: f64,
    since_failure: u32,
}

impl Adaptive {
    /// From a calibration's Gram matrix, its least-squares solution and the root mean square of what that leaves, nT.
    pub fn new(gram: &Matrix, solution: Vector, noise_nt: f64) -> Self {
        let noise = noise_nt * noise_nt;
        let members = (0..6).map(|i| {
            let beta = if i == 4 { Vector::zeros() } else { solution };
            let open = if i >= 3 { 25.0 } else { 1.0 };
            Member::new(gram * (INFORMATION_SHARES[i] * gain()), beta, open * noise, noise, -PRIOR_COST_NATS[i])
        });
        let mut bank = Self {
            beta: solution,
            members: members.collect(),
            before: (Vector::zeros(), 0.0),
            epochs: 0,
            failures: 0.0,
            since_failure: u32::MAX,
        };
        bank.average();
        bank
    }

    fn probabilities(&self) -> Vec<f64> {
        let best = self.members.iter().map(|member| member.log_evidence).fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = self.members.iter().map(|m| (m.log_evidence - best).max(-30.0).exp()).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|weight| weight / sum).collect()
    }

    fn average(&mut self) {
        let probabilities = self.probabilities();
        self.beta = self.members.iter().zip(probabilities).map(|(member, p)| member.beta * p).sum();
    }

    fn aged_noise(&self) -> f64 {
        self.members.iter().zip(self.probabilities()).map(|(member, p)| member.aged_noise * p).sum()
    }

    /// One settled epoch.
    pub fn update(&mut self, x: &Vector, y: f64) {
        let (x_before, y_before) = std::mem::replace(&mut self.before, (*x, y));
        let (dx, dy) = (x - x_before * RHO, y - y_before * RHO);
        if self.epochs.is_multiple_of(15) {
            self.members.iter_mut().for_each(|member| member.aged = [member.aged[1], member.beta]);
        }
        self.epochs += 1;
        self.weigh(x, y);
        for (i, member) in self.members.iter_mut().enumerate() {
            // 10 Hz over twice the bandwidth of 0.8 Hz: so many rows to an independent one.
            let (x_learnt, y_learnt, gain) = if i == PLAIN { (*x, y, 6.25) } else { (dx, dy, gain()) };
            let uncertainty = gain * x.dot(&solve(&member.information, x));
            let innovation = (y - x.dot(&member.beta)).abs() / (member.noise * (1.0 + uncertainty)).sqrt();
            let weight = (GATES[i] / innovation).powi(4).min(1.0);
            member.noise = tracked(member.noise, innovation, 1.0 / 300.0 / (1.0 + uncertainty));
            let gamma = 1.0 - FORGETTING_MULTIPLIERS[i] * 1e-4;
            member.information = member.information * gamma + x_learnt * x_learnt.transpose() * weight;
            member.right = member.right * gamma + x_learnt * (y_learnt * weight);
            member.beta = solve(&member.information, &member.right);
            member.age += 1;
        }
        self.average();
        self.reinitialise();
    }

    fn weigh(&mut self, x: &Vector, y: f64) {
        let noise = self.aged_noise();
        let mut least = f64::INFINITY;
        for (member, cost) in self.members.iter_mut().zip(PRIOR_COST_NATS) {
            let square = (y - x.dot(&member.aged[0])).powi(2);
            least = least.min(square);
            member.aged_noise = tracked(member.aged_noise, (square / member.aged_noise).sqrt(), 1.0 / 300.0);
            let loss = 2.5 / 6.25 * (1.0 + square / (4.0 * noise)).ln();
            member.log_evidence = member.log_evidence * (1.0 - 1.0 / 600.0) - cost / 600.0 - loss;
        }
        let best = self.members.iter().map(|member| member.log_evidence).fold(f64::NEG_INFINITY, f64::max);
        self.members.iter_mut().for_each(|member| member.log_evidence = (member.log_evidence - best).max(-30.0));
        let failed = if least > 2.5 * 2.5 * noise { 1.0 } else { 0.0 };
        self.failures += (failed - self.failures) / 100.0;
    }

    fn reinitialise(&mut self) {
        let probabilities = self.probabilities();
        let leader = (0..6).max_by(|&a, &b| probabilities[a].total_cmp(&probabilities[b])).unwrap();
        let (long, short) = (self.members[3].age, self.members[4].age);
        let waiting = if leader == 3 || (leader != 4 && short > long) { 4 } else { 3 };
        let failing = self.failures > 0.5;
        self.since_failure = if failing { 0 } else { self.since_failure.saturating_add(1) };
        let over = self.since_failure == 300;
        let due = [waiting, PLAIN].map(|i| i != leader && (over || failing && self.members[i].age >= 300));
        if due[0] {
            self.replace(waiting, leader);
        } else if leader != 3 && long >= 6000 {
            self.replace(3, leader);
        }
        if due[1] {
            self.replace(PLAIN, leader);
        }
    }

    fn replace(&mut self, member: usize, leader: usize) {
        let (information, noise) = (self.members[leader].information * 1e-6, self.members[leader].noise);
        let aged_noise = self.aged_noise();
        self.members[member] = Member::new(information, self.beta, 25.0 * noise, aged_noise, -10.0);
    }
}

fn tracked(variance: f64, innovation: f64, rate: f64) -> f64 {
    (variance * (1.0 + rate * (innovation.min(2.5).powi(2) / 0.978 - 1.0))).max(1e-8)
}
