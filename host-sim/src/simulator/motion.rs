//! How a body moves: a course of legs and turns, and oscillations about it.

use std::f64::consts::{PI, TAU};

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Attitude of the body: roll starboard down, pitch nose up, heading from true north by east; radians.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attitude {
    /// Roll, rad.
    pub roll: f64,
    /// Pitch, rad.
    pub pitch: f64,
    /// Heading, rad.
    pub heading: f64,
}

impl Attitude {
    /// A vector given as north, east, down, in body axes x forward, y starboard, z down.
    pub fn to_body(&self, [north, east, down]: [f64; 3]) -> [f64; 3] {
        let (sin_heading, cos_heading) = libm::sincos(self.heading);
        let (sin_pitch, cos_pitch) = libm::sincos(self.pitch);
        let (sin_roll, cos_roll) = libm::sincos(self.roll);
        let (ahead, right) = (cos_heading * north + sin_heading * east, cos_heading * east - sin_heading * north);
        let (x, below) = (cos_pitch * ahead - sin_pitch * down, sin_pitch * ahead + cos_pitch * down);
        [x, cos_roll * right + sin_roll * below, cos_roll * below - sin_roll * right]
    }
}

/// Straight legs of one length, and the same turn after each: to starboard, or to either side by turns.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Heading of the first leg, degrees.
    pub first_heading_deg: f64,
    /// Time on a leg, s.
    pub leg_s: f64,
    /// Time that a turn takes, s.
    pub turn_s: f64,
    /// Angle of a turn, to starboard, degrees.
    pub turn_deg: f64,
    /// Every other turn is to port: lines side by side.
    pub alternates: bool,
}

impl Course {
    /// Which leg (or the turn after it) it is at a time, counted from zero.
    pub fn leg(&self, time_s: f64) -> f64 {
        (time_s / (self.leg_s + self.turn_s)).floor()
    }

    pub(super) fn heading_deg(&self, time_s: f64) -> f64 {
        let leg = self.leg(time_s);
        let into_turn = (time_s - leg * (self.leg_s + self.turn_s) - self.leg_s) / self.turn_s;
        let share = into_turn.clamp(0.0, 1.0);
        // Smooth at both ends up to the second derivative: a towed body does not turn with a jerk.
        let turned = share * share * share * (10.0 + share * (6.0 * share - 15.0));
        if self.alternates {
            let is_back = leg.rem_euclid(2.0) == 1.0;
            return self.first_heading_deg + self.turn_deg * if is_back { 1.0 - turned } else { turned };
        }
        self.first_heading_deg + self.turn_deg * (leg + turned)
    }
}

/// An oscillation about one axis: a sum of sines that never repeats within a day.
#[derive(Clone, Debug)]
pub struct Oscillation {
    sines: Vec<(f64, f64, f64)>,
}

impl Oscillation {
    /// `count` sines of random phase, spread over `low_hz` to `high_hz`, together `rms_deg` degrees rms.
    pub fn random(rms_deg: f64, low_hz: f64, high_hz: f64, count: usize, random: &mut impl Rng) -> Self {
        let amplitude = rms_deg.to_radians() * (2.0 / count as f64).sqrt();
        let sines = (0..count)
            .map(|k| {
                let share = (k as f64 + random.random_range(0.0..1.0)) / count as f64;
                (amplitude, TAU * (low_hz + (high_hz - low_hz) * share), random.random_range(0.0..TAU))
            })
            .collect();
        Self { sines }
    }

    /// Its angle at a time, rad.
    pub fn angle(&self, time_s: f64) -> f64 {
        self.sines.iter().map(|(amplitude, omega, phase)| amplitude * libm::sin(omega * time_s + phase)).sum()
    }
}

/// Course and oscillations. In a manoeuvre, the oscillations come one axis after the other.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Where it heads.
    pub course: Course,
    /// Oscillation of roll, pitch and heading.
    pub oscillations: [Oscillation; 3],
    /// Share of each leg, 0 to 1, in which one axis after the other oscillates alone; 0: all at all times.
    pub one_by_one: f64,
}

impl Motion {
    /// The motion of a tow: all three axes at once, with the given rms and at wave frequencies.
    pub fn tow(course: Course, rms_deg: [f64; 3], seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let oscillations = rms_deg.map(|rms_deg| Oscillation::random(rms_deg, 0.06, 0.45, 14, &mut random));
        Self { course, oscillations, one_by_one: 0.0 }
    }

    /// Attitude at a time, s.
    pub fn attitude(&self, time_s: f64) -> Attitude {
        let share = std::array::from_fn::<f64, 3, _>(|axis| self.share(axis, time_s));
        let angle = |axis: usize| share[axis] * self.oscillations[axis].angle(time_s);
        let heading = self.course.heading_deg(time_s).to_radians() + angle(2);
        Attitude { roll: angle(0), pitch: angle(1), heading }
    }

    /// How much of an axis's oscillation is on at a time: smooth windows one after the other on each leg.
    fn share(&self, axis: usize, time_s: f64) -> f64 {
        if self.one_by_one == 0.0 {
            return 1.0;
        }
        let Course { leg_s, turn_s, .. } = self.course;
        let into_leg = time_s - self.course.leg(time_s) * (leg_s + turn_s);
        let window_s = self.one_by_one * leg_s / 3.0;
        let x = (into_leg - axis as f64 * window_s) / window_s;
        if (0.0..=1.0).contains(&x) { libm::sin(PI * x).powi(2) } else { 0.0 }
    }
}
