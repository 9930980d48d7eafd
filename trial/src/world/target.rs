//! Iron that the body passes: dipoles on straight lines, in the total field and so in both sensors.

use rand::RngExt;
use rand_distr::{Distribution, Poisson, StandardNormal};

use super::grid::Grid;
use super::state::World;
use super::vector::{Vector, dot, length, scaled};
use crate::answer::Target;
use crate::random::Random;

/// Without a target at the ends, s: a filter that settles there would hide it.
const ENDS_S: f64 = 20.0;
/// How wide the largest lobe may be, s.
const WIDTHS_S: std::ops::RangeInclusive<f64> = 1.0..=15.0;
/// Samples of a lobe, from as many times its length before the nearest point to as many after.
const STEPS: i32 = 2000;
const REACH: f64 = 8.0;
/// Until one is at a place where it can be seen.
const TRIES: usize = 50;

/// A dipole that is passed on a straight line.
#[derive(Clone, Debug)]
pub(crate) struct Dipole {
    /// When it is nearest, s since the first row.
    nearest_s: f64,
    /// North, east, down, m/s.
    velocity_m_per_s: Vector,
    /// From the dipole to the body where it is nearest, m.
    offset_m: Vector,
    /// Magnetic constant over 4 pi times its moment, nT m^3.
    moment_nt_m3: Vector,
    /// What of it is seen, on the recording's time axis.
    pub(crate) seen: Target,
}

/// Those of a recording: at least one, apart from each other and from holes.
pub(crate) fn draw(world: &World, draw: &mut Random) -> Vec<Dipole> {
    let a_minute = log_uniform([0.05, 1.0], draw);
    let mean = a_minute * world.grid.duration_s() / 60.0;
    let count = Poisson::new(mean).map_or(1.0, |poisson| poisson.sample(draw)).max(1.0);
    let mut all: Vec<Dipole> = Vec::new();
    for _ in 0..count as usize {
        let place = |draw: &mut Random| Some(any(world, draw)).filter(|one| is_clear(world, &all, &one.seen));
        let one = (0..TRIES).find_map(|_| place(draw));
        all.extend(one);
    }
    all.sort_by(|a, b| a.seen.time_s.total_cmp(&b.seen.time_s));
    all
}

impl World {
    /// The same world with dipoles on the way.
    pub(crate) fn with_targets(mut self, dipoles: &[Dipole]) -> Self {
        let times_s: Vec<f64> = self.grid.times_s().collect();
        for (at, time_s) in times_s.into_iter().enumerate() {
            let anomaly_nt: f64 = dipoles.iter().map(|dipole| dipole.anomaly_nt(self.earth, time_s)).sum();
            let direction = self.direction[at];
            // The body's induced and eddy parts grow with the field.
            let induced = dot(direction, self.body.still_nt(1.0, direction)) - dot(direction, self.body.permanent_nt);
            let eddy = dot(direction, self.body.eddy_nt(1.0, self.rate[at]));
            self.field_nt[at] += anomaly_nt;
            self.scalar_nt[at] += anomaly_nt * (1.0 + induced + eddy);
            if let Some(nt) = self.eddy_nt.get_mut(at) {
                *nt += anomaly_nt * eddy;
            }
        }
        self
    }
}

impl Dipole {
    /// Its field along that of the Earth, nT.
    fn anomaly_nt(&self, earth: Vector, time_s: f64) -> f64 {
        let since_s = time_s - self.nearest_s;
        let place: Vector = std::array::from_fn(|k| self.offset_m[k] + since_s * self.velocity_m_per_s[k]);
        let distance_m = length(place);
        let unit = scaled(place, 1.0 / distance_m);
        let moment = self.moment_nt_m3;
        (3.0 * dot(moment, unit) * dot(unit, earth) - dot(moment, earth)) / distance_m.powi(3)
    }

    /// Time since the nearest point, size and width of the largest lobe.
    fn largest_lobe(&self, earth: Vector) -> Target {
        let step_s = REACH * length(self.offset_m) / length(self.velocity_m_per_s) / f64::from(STEPS);
        let at = |step: i32| self.anomaly_nt(earth, self.nearest_s + step_s * f64::from(step));
        let size = |step: &i32| at(*step).abs();
        let top = (-STEPS..=STEPS).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
        let peak_nt = at(top);
        let is_inside = |step: &i32| at(*step) / peak_nt > 0.5;
        let last = (top..=STEPS).take_while(is_inside).last().unwrap_or(top);
        let first = (-STEPS..=top).rev().take_while(is_inside).last().unwrap_or(top);
        // Straight between the last sample inside and the first one outside.
        let beyond = |inside: i32, outside: i32| (at(inside) - 0.5 * peak_nt) / (at(inside) - at(outside));
        let steps = f64::from(last - first) + beyond(last, last + 1) + beyond(first, first - 1);
        Target { time_s: step_s * f64::from(top), peak_nt, width_s: step_s * steps }
    }
}

/// Iron on the ground or beside the way, with an induced and a remanent moment.
fn any(world: &World, draw: &mut Random) -> Dipole {
    loop {
        let course = draw.random_range(0.0..std::f64::consts::TAU);
        // From beside, over it, to beside on the other side.
        let below = draw.random_range(0.1..0.9) * std::f64::consts::PI;
        let (sin, cos) = libm::sincos(course);
        let (down, aside) = libm::sincos(below);
        let velocity_m_per_s = scaled([cos, sin, 0.0], draw.random_range(1.5..3.0));
        let offset_m = scaled([-sin * aside, cos * aside, -down], log_uniform([2.0, 30.0], draw));
        let remanent = scaled(any_direction(draw), log_uniform([0.1, 10.0], draw));
        let moment_nt_m3 = std::array::from_fn(|k| world.earth[k] + remanent[k]);
        let seen = Target { time_s: 0.0, peak_nt: 0.0, width_s: 0.0 };
        let unit = Dipole { nearest_s: 0.0, velocity_m_per_s, offset_m, moment_nt_m3, seen };
        let lobe = unit.largest_lobe(world.earth);
        if WIDTHS_S.contains(&lobe.width_s) {
            let peak_nt = peak_nt(draw);
            let time_s = draw.random_range(ENDS_S..world.grid.duration_s() - ENDS_S);
            let by = peak_nt / lobe.peak_nt.abs();
            return Dipole {
                nearest_s: time_s - lobe.time_s,
                moment_nt_m3: scaled(moment_nt_m3, by),
                seen: Target {
                    time_s: world.columns.first_time_s + time_s,
                    peak_nt: by * lobe.peak_nt,
                    width_s: lobe.width_s,
                },
                ..unit
            };
        }
    }
}

/// Its lobe is not in a hole and not in another's.
fn is_clear(world: &World, others: &[Dipole], seen: &Target) -> bool {
    let is_apart = |other: &Dipole| (other.seen.time_s - seen.time_s).abs() > 2.0 * (other.seen.width_s + seen.width_s);
    let time_s = seen.time_s - world.columns.first_time_s;
    let is_whole = |hole: &std::ops::Range<usize>| {
        Grid::row_s(hole.end) < time_s - seen.width_s || Grid::row_s(hole.start) > time_s + seen.width_s
    };
    others.iter().all(is_apart) && world.columns.lost.iter().chain(&world.columns.invalid).all(is_whole)
}

/// Mostly small; one in twenty is large.
fn peak_nt(draw: &mut Random) -> f64 {
    let is_large = draw.random_bool(0.05);
    log_uniform(if is_large { [300.0, 3000.0] } else { [0.5, 300.0] }, draw)
}

fn log_uniform([low, high]: [f64; 2], draw: &mut Random) -> f64 {
    low * libm::pow(high / low, draw.random::<f64>())
}

fn any_direction(draw: &mut Random) -> Vector {
    let any: Vector = std::array::from_fn(|_| StandardNormal.sample(draw));
    scaled(any, 1.0 / length(any))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::Setting;
    use rand::SeedableRng;

    fn world(seed: u64) -> World {
        World::draw(6000, Setting::Trial, &mut Random::seed_from_u64(seed), &mut Random::seed_from_u64(seed + 1))
    }

    #[test]
    fn over_a_vertical_dipole_in_a_vertical_field_the_anomaly_is_that_of_the_textbook() {
        let seen = Target { time_s: 0.0, peak_nt: 0.0, width_s: 0.0 };
        let (velocity_m_per_s, offset_m) = ([2.0, 0.0, 0.0], [0.0, 0.0, -4.0]);
        let dipole = Dipole { nearest_s: 10.0, velocity_m_per_s, offset_m, moment_nt_m3: [0.0, 0.0, 640.0], seen };
        let down = [0.0, 0.0, 1.0];
        // m (2 z^2 - x^2) / (x^2 + z^2)^(5/2): 2 m / z^3 = 20 nT above it, none at x = z root 2.
        for (time_s, nt) in [(10.0, 20.0), (10.0 + 2.0 * 2.0_f64.sqrt(), 0.0)] {
            assert!((dipole.anomaly_nt(down, time_s) - nt).abs() < 1e-9);
        }
        let at_x = |x: f64| 640.0 * (32.0 - x * x) / (x * x + 16.0).powf(2.5);
        assert!((dipole.anomaly_nt(down, 11.0) - at_x(2.0)).abs() < 1e-9);
        let lobe = dipole.largest_lobe(down);
        assert!((lobe.peak_nt - 20.0).abs() < 1e-9 && lobe.time_s == 0.0);
        // Half of it where at_x is 10 nT, at x = 2.02 m: as wide as it is deep, at 2 m/s.
        let half_m = 0.5 * lobe.width_s * 2.0;
        assert!((at_x(half_m) - 10.0).abs() < 0.01, "{half_m}");
    }

    #[test]
    fn targets_are_in_both_sensors_as_they_are_told() {
        for seed in 0..6 {
            let dipoles = draw(&world(seed), &mut Random::seed_from_u64(seed));
            assert!(!dipoles.is_empty());
            let (before, after) = (world(seed).clean(), world(seed).with_targets(&dipoles).clean());
            let seen_nt: Vec<f64> =
                after.flux_nt.iter().zip(&before.flux_nt).map(|(a, b)| length(*a) - length(*b)).collect();
            for Dipole { seen, .. } in &dipoles {
                let row = (10.0 * (seen.time_s - world(seed).columns.first_time_s)).round() as usize;
                let others: f64 = dipoles
                    .iter()
                    .filter(|other| other.seen.time_s != seen.time_s)
                    .map(|other| other.anomaly_nt(world(seed).earth, Grid::row_s(row)))
                    .sum();
                assert!((seen_nt[row] - others - seen.peak_nt).abs() < 0.03 * seen.peak_nt.abs(), "{seen:?}");
                assert!((200..5800).contains(&row) && WIDTHS_S.contains(&seen.width_s));
                let scalar_nt = after.scalar_nt[row] - before.scalar_nt[row];
                assert!((scalar_nt / seen_nt[row] - 1.0).abs() < 0.05);
            }
        }
    }
}
