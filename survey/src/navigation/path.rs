//! A way through smoothed fixes: where, and how fast, at any time.

use super::fix::Fix;
use super::smoother::{Node, smooth};
use crate::statistics::median;

/// Where a body is and how fast, easting and northing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    pub(crate) place_m: [f64; 2],
    pub(crate) velocity_m_per_s: [f64; 2],
    /// Of which stretch of fixes: from one to the next places may step.
    pub(crate) stretch: usize,
}

/// A longer time without a fix is not bridged, s: in the middle of it a turn at 0.1 m/s2 is cut by 0.1 T^2 / 8 = 1.25 m.
const LONGEST_BRIDGE_S: f64 = 10.0;
/// But of a receiver that is slow itself so many of its steps are, up to a minute: its turns are cut, its legs are not.
const LONGEST_BRIDGE_STEPS: f64 = 2.5;
const LONGEST_BRIDGE_OF_ANY_S: f64 = 60.0;
/// So much before the first fix of a stretch and after its last one the way goes straight on, s.
const LONGEST_EXTRAPOLATION_S: f64 = 1.5;

/// The way, in stretches.
#[derive(Clone, Debug, Default)]
pub(crate) struct Path {
    stretches: Vec<Vec<Node>>,
}

impl Path {
    /// Through these fixes, in the order of time, not from one part to the next.
    pub(crate) fn through(parts: &[Vec<Fix>]) -> Self {
        let pairs = parts.iter().flat_map(|fixes| fixes.windows(2));
        let usual_s = median(&mut pairs.map(|pair| pair[1].time_s - pair[0].time_s).collect::<Vec<_>>());
        let steps_s = LONGEST_BRIDGE_STEPS * usual_s.unwrap_or(0.0);
        let bridge_s = steps_s.clamp(LONGEST_BRIDGE_S, LONGEST_BRIDGE_OF_ANY_S);
        let is_bridged = |before: &Fix, after: &Fix| after.time_s - before.time_s <= bridge_s;
        let stretches: Vec<&[Fix]> = parts.iter().flat_map(|fixes| fixes.chunk_by(is_bridged)).collect();
        Self { stretches: smooth(&stretches) }
    }

    /// The motion at each of these times, `None` where no fix is near. NaN is no time.
    pub(crate) fn at(&self, times_s: &[f64]) -> Vec<Option<Motion>> {
        times_s.iter().map(|&time_s| self.motion(time_s)).collect()
    }

    fn motion(&self, time_s: f64) -> Option<Motion> {
        let is_in = |nodes: &&Vec<Node>| {
            let ends = nodes.first().zip(nodes.last());
            ends.is_some_and(|(first, last)| {
                (first.time_s - LONGEST_EXTRAPOLATION_S..=last.time_s + LONGEST_EXTRAPOLATION_S).contains(&time_s)
            })
        };
        let stretch = self.stretches.iter().position(|nodes| is_in(&nodes))?;
        let nodes = &self.stretches[stretch];
        let (place_m, velocity_m_per_s) = match nodes.partition_point(|node| node.time_s <= time_s) {
            0 => straight(&nodes[0], time_s),
            at if at == nodes.len() => straight(&nodes[at - 1], time_s),
            at => between(&nodes[at - 1], &nodes[at], time_s),
        };
        Some(Motion { place_m, velocity_m_per_s, stretch })
    }
}

/// Place and velocity.
type State = ([f64; 2], [f64; 2]);

fn straight(node: &Node, time_s: f64) -> State {
    let step_s = time_s - node.time_s;
    let place_m = std::array::from_fn(|axis| node.place_m[axis] + step_s * node.velocity_m_per_s[axis]);
    (place_m, node.velocity_m_per_s)
}

/// The cubic with both places and velocities: the mean of an integrated Wiener process between two known states.
fn between(a: &Node, b: &Node, time_s: f64) -> State {
    let step_s = b.time_s - a.time_s;
    let u = (time_s - a.time_s) / step_s;
    let of_axis = |axis: usize| {
        let (p, q) = (a.place_m[axis], b.place_m[axis]);
        let (v, w) = (a.velocity_m_per_s[axis] * step_s, b.velocity_m_per_s[axis] * step_s);
        let (c2, c3) = (3.0 * (q - p) - 2.0 * v - w, 2.0 * (p - q) + v + w);
        let place_m = p + u * (v + u * (c2 + u * c3));
        (place_m, (v + u * (2.0 * c2 + 3.0 * u * c3)) / step_s)
    };
    let axes = [of_axis(0), of_axis(1)];
    (axes.map(|axis| axis.0), axes.map(|axis| axis.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixes(times_s: impl Iterator<Item = f64>) -> Vec<Fix> {
        times_s.map(|time_s| Fix { time_s, place_m: [2.0 * time_s, 0.01 * time_s * time_s] }).collect()
    }

    #[test]
    fn between_fixes_it_follows_the_curve() {
        let path = Path::through(&[fixes((0..100).map(f64::from))]);
        for (time_s, motion) in [10.5, 33.3, 70.7].into_iter().zip(path.at(&[10.5, 33.3, 70.7])) {
            let motion = motion.unwrap();
            assert!((motion.place_m[0] - 2.0 * time_s).abs() < 1e-2, "{motion:?}");
            assert!((motion.place_m[1] - 0.01 * time_s * time_s).abs() < 1e-2, "{motion:?}");
            assert!((motion.velocity_m_per_s[1] - 0.02 * time_s).abs() < 1e-2, "{motion:?}");
        }
    }

    #[test]
    fn from_part_to_part_it_steps() {
        let mut beside = fixes((100..200).map(f64::from));
        beside.iter_mut().for_each(|fix| fix.place_m[0] += 7.0);
        let path = Path::through(&[fixes((0..100).map(f64::from)), beside]);
        let [before, after] = [path.motion(98.0).unwrap(), path.motion(101.0).unwrap()];
        assert!((after.place_m[0] - before.place_m[0] - 13.0).abs() < 1e-2 && before.stretch != after.stretch);
        assert!((after.velocity_m_per_s[0] - 2.0).abs() < 1e-2, "{after:?}");
    }

    #[test]
    fn a_long_gap_is_not_bridged() {
        let path = Path::through(&[fixes((0..20).chain(40..60).map(f64::from))]);
        let known: Vec<bool> = path
            .at(&[-3.0, -1.0, 0.0, 19.0, 20.0, 30.0, 39.0, 59.5, 61.0, f64::NAN])
            .iter()
            .map(Option::is_some)
            .collect();
        assert_eq!(known, [false, true, true, true, true, false, true, true, false, false]);
    }
}
