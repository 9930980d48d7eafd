//! Iron that the body passes: dipoles, in the total field and so in both sensors.

mod dipole;
mod pass;

use std::ops::Range;

use rand::RngExt;
use rand_distr::{Distribution, Poisson, StandardNormal};

use super::grid::Grid;
use super::state::World;
use super::vector::{Vector, dot, length, scaled};
use crate::answer::Target;
use crate::random::{Random, log_uniform};
pub(crate) use dipole::Dipole;
use pass::Pass;

/// Without a target at the ends, s: a filter that settles there would hide it.
const ENDS_S: f64 = 20.0;
/// How wide the largest lobe may be, s.
const WIDTHS_S: std::ops::RangeInclusive<f64> = 1.0..=15.0;
/// What another may add to a peak, of that.
const MOST_BESIDE: f64 = 0.3;
/// Until one is at a place where it can be seen.
const TRIES: usize = 50;

/// Those of a recording that is made: at least one.
pub(crate) fn draw(world: &World, draw: &mut Random) -> Vec<Dipole> {
    let a_minute = log_uniform([0.05, 1.0], draw);
    let mean = a_minute * world.grid.duration_s() / 60.0;
    let count = Poisson::new(mean).map_or(1.0, |poisson| poisson.sample(draw)).max(1.0);
    some(world, count as usize, &any_peak_nt, draw)
}

/// One to three, with peaks of `least_nt` to twenty times that.
pub(crate) fn draw_large(world: &World, least_nt: f64, draw: &mut Random) -> Vec<Dipole> {
    let count = draw.random_range(1..=3_usize);
    some(world, count, &|draw| log_uniform([least_nt, 20.0 * least_nt], draw), draw)
}

/// The same passed by a body that heaves and turns, their peaks as large. One whose lobe would be too narrow or too wide then is passed on
/// a straight line.
pub(crate) fn passed_roughly(world: &World, dipoles: Vec<Dipole>, draw: &mut Random) -> Vec<Dipole> {
    let sea = Pass::in_a_sea(draw);
    let rough = |straight: Dipole| {
        let turned = Dipole { pass: sea.with_any_turn(draw), ..straight.clone() };
        let lobe = turned.largest_lobe(world.earth);
        let by = (straight.seen.peak_nt / lobe.peak_nt).abs();
        let time_s = world.columns.first_time_s + turned.nearest_s + lobe.time_s;
        let seen = Target { time_s, peak_nt: by * lobe.peak_nt, width_s: lobe.width_s };
        let is_seen = WIDTHS_S.contains(&lobe.width_s);
        if is_seen { Dipole { moment_nt_m3: scaled(turned.moment_nt_m3, by), seen, ..turned } } else { straight }
    };
    dipoles.into_iter().map(rough).collect()
}

/// As many, apart from each other and from holes; fewer where there is no room.
fn some(world: &World, count: usize, peak_nt: &impl Fn(&mut Random) -> f64, draw: &mut Random) -> Vec<Dipole> {
    let mut all: Vec<Dipole> = Vec::new();
    for _ in 0..count {
        let place = |draw: &mut Random| Some(any(world, peak_nt(draw), draw)).filter(|one| is_clear(world, &all, one));
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

/// Iron on the ground or beside the way, with an induced and a remanent moment.
fn any(world: &World, peak_nt: f64, draw: &mut Random) -> Dipole {
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
        let pass = Pass::default();
        let unit = Dipole { nearest_s: 0.0, velocity_m_per_s, pass, offset_m, moment_nt_m3, seen };
        let lobe = unit.largest_lobe(world.earth);
        if WIDTHS_S.contains(&lobe.width_s) {
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

/// Its lobe is not in a hole, not in another's, and neither is lost in the other's tail.
fn is_clear(world: &World, others: &[Dipole], one: &Dipole) -> bool {
    let since_first_s = |dipole: &Dipole| dipole.seen.time_s - world.columns.first_time_s;
    let is_seen_beside =
        |a: &Dipole, b: &Dipole| b.anomaly_nt(world.earth, since_first_s(a)).abs() < MOST_BESIDE * a.seen.peak_nt.abs();
    let is_apart = |other: &Dipole| {
        let apart_s = (other.seen.time_s - one.seen.time_s).abs();
        let are_seen = is_seen_beside(one, other) && is_seen_beside(other, one);
        are_seen && apart_s > 2.0 * (other.seen.width_s + one.seen.width_s)
    };
    let (time_s, width_s) = (since_first_s(one), one.seen.width_s);
    let is_whole =
        |hole: &Range<usize>| Grid::row_s(hole.end) < time_s - width_s || Grid::row_s(hole.start) > time_s + width_s;
    others.iter().all(is_apart) && world.columns.lost.iter().chain(&world.columns.invalid).all(is_whole)
}

/// Mostly small; one in twenty is large.
fn any_peak_nt(draw: &mut Random) -> f64 {
    let is_large = draw.random_bool(0.05);
    log_uniform(if is_large { [300.0, 3000.0] } else { [0.5, 300.0] }, draw)
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
    fn targets_are_in_both_sensors_as_they_are_told() {
        for (seed, is_rough) in (0..6).flat_map(|seed| [(seed, false), (seed, true)]) {
            let mut random = Random::seed_from_u64(seed);
            let world = world(seed);
            let straight = draw(&world, &mut random);
            let peaks_nt = |dipoles: &[Dipole]| dipoles.iter().map(|one| one.seen.peak_nt.abs()).collect::<Vec<f64>>();
            let asked_nt = peaks_nt(&straight);
            let dipoles = if is_rough { passed_roughly(&world, straight, &mut random) } else { straight };
            assert!(peaks_nt(&dipoles).iter().zip(&asked_nt).all(|(nt, asked)| (nt / asked - 1.0).abs() < 1e-9));
            assert!(!dipoles.is_empty());
            let (before, after) = (world.clean(), world.clone().with_targets(&dipoles).clean());
            let seen_nt: Vec<f64> =
                after.flux_nt.iter().zip(&before.flux_nt).map(|(a, b)| length(*a) - length(*b)).collect();
            for Dipole { seen, .. } in &dipoles {
                let row = (10.0 * (seen.time_s - world.columns.first_time_s)).round() as usize;
                let others: f64 = dipoles
                    .iter()
                    .filter(|other| other.seen.time_s != seen.time_s)
                    .map(|other| other.anomaly_nt(world.earth, Grid::row_s(row)))
                    .sum();
                assert!((seen_nt[row] - others - seen.peak_nt).abs() < 0.03 * seen.peak_nt.abs(), "{seen:?}");
                assert!((200..5800).contains(&row) && WIDTHS_S.contains(&seen.width_s));
                let scalar_nt = after.scalar_nt[row] - before.scalar_nt[row];
                assert!((scalar_nt / seen_nt[row] - 1.0).abs() < 0.05);
            }
        }
    }
}
