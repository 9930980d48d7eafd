//! Clocks and buffers: when the sensors are read, in ways that no effect of the library has.

use std::f64::consts::TAU;

use rand::RngExt;

use super::super::super::effects::read_late;
use super::super::super::grid::Grid;
use super::super::super::vector::Vector;
use super::super::super::{Change, World};
use super::super::mechanism::{Mechanism, driven, mechanism};
use super::super::shape::{instants, standard};
use crate::random::Random;

pub(super) static ALL: [Mechanism; 6] = [
    mechanism("clock_hops", clock_hops),
    mechanism("clock_wander", clock_wander),
    mechanism("late_bursts", late_bursts),
    driven("reading_dependent_delay", &["reading"], reading_dependent_delay),
    mechanism("beating_clocks", beating_clocks),
    driven("late_axis", &["attitude_rate"], late_axis),
];

/// What a delay is at unit size, s: changes are taken to grow with it.
const DELAY_S: f64 = 0.01;

/// A clock that hops back and forth by some milliseconds.
fn clock_hops(world: &World, draw: &mut Random) -> Change {
    let hops = instants(world.grid.duration_s(), draw.random_range(3.0..15.0), draw);
    late(world, |_, t| if hops.partition_point(|hop| *hop <= t) % 2 == 0 { -DELAY_S } else { DELAY_S })
}

/// A clock that is early and late in turn, as its oven warms and cools.
fn clock_wander(world: &World, draw: &mut Random) -> Change {
    let (period_s, start) = (draw.random_range(12.0..60.0), draw.random_range(0.0..TAU));
    late(world, |_, t| DELAY_S * libm::sin(TAU * t / period_s + start))
}

/// A buffer that fills up now and then: a burst of late readings, until it has drained.
fn late_bursts(world: &World, draw: &mut Random) -> Change {
    let drain_s = draw.random_range(1.0..5.0);
    let bursts = instants(world.grid.duration_s(), draw.random_range(8.0..30.0), draw);
    late(world, |_, t| {
        let last = bursts.partition_point(|burst| *burst <= t);
        let since_s = last.checked_sub(1).map_or(f64::INFINITY, |last| t - bursts[last]);
        DELAY_S * (1.0 - since_s / drain_s).max(0.0)
    })
}

/// A counter that takes the longer the lower the field is.
fn reading_dependent_delay(world: &World, _: &mut Random) -> Change {
    let field = world.grid.at_rows(&standard(&world.scalar_nt));
    late(world, |row, _| -DELAY_S * field[row])
}

/// A sensor with a clock of its own, latched at each row: its reading ages evenly, then is new at once.
fn beating_clocks(world: &World, draw: &mut Random) -> Change {
    let (period_s, start) = (draw.random_range(4.0..30.0), draw.random_range(0.0..1.0));
    late(world, |_, t| DELAY_S * sawtooth(t / period_s + start))
}

/// One axis of the fluxgate that is converted later than the other two.
fn late_axis(world: &World, draw: &mut Random) -> Change {
    let (axis, sign) = (draw.random_range(0..3_usize), if draw.random_bool(0.5) { 1.0 } else { -1.0 });
    let fine: Vec<f64> = world.direction.iter().zip(&world.field_nt).map(|(c, nt)| nt * c[axis]).collect();
    let change = |row: usize| {
        let mut change: Vector = [0.0; 3];
        change[axis] = world.grid.at(&fine, Grid::row_s(row) - sign * DELAY_S) - fine[Grid::of_row(row)];
        change
    };
    Change { scalar_nt: Vec::new(), flux_nt: (0..world.rows()).map(change).collect() }
}

/// Read late and early: the mean delay, which would be a lag, is corrected for.
fn late(world: &World, late_s: impl Fn(usize, f64) -> f64) -> Change {
    let late_s: Vec<f64> = (0..world.rows()).map(|row| late_s(row, Grid::row_s(row))).collect();
    let mean_s = late_s.iter().sum::<f64>() / late_s.len() as f64;
    Change::of_scalar(read_late(world, |row, _| late_s[row] - mean_s))
}

/// From 0 to 1, then from 0 again.
fn sawtooth(turns: f64) -> f64 {
    turns - turns.floor()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::Setting;
    use rand::SeedableRng;

    #[test]
    fn late_readings_are_the_slope_times_the_delay() {
        let of = |seed: u64| {
            World::draw(1200, Setting::Trial, &mut Random::seed_from_u64(seed), &mut Random::seed_from_u64(seed))
        };
        let world = (0..).map(of).find(|world| world.columns.lost.is_empty()).unwrap();
        let rate = world.grid.at_rows(&Grid::derivative(&world.scalar_nt));
        let largest = rate.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let change = clock_wander(&world, &mut Random::seed_from_u64(3)).scalar_nt;
        let draw = &mut Random::seed_from_u64(3);
        let (period_s, start) = (draw.random_range(12.0..60.0), draw.random_range(0.0..TAU));
        let late_s: Vec<f64> = (0..1200).map(|row| 0.01 * (TAU * Grid::row_s(row) / period_s + start).sin()).collect();
        let mean_s = late_s.iter().sum::<f64>() / 1200.0;
        for (row, nt) in change.iter().enumerate() {
            assert!((nt + (late_s[row] - mean_s) * rate[row]).abs() < 0.05 * 0.01 * largest, "{row}");
        }
    }

    #[test]
    fn only_the_late_axis_changes() {
        let world = World::draw(1200, Setting::Trial, &mut Random::seed_from_u64(1), &mut Random::seed_from_u64(1));
        let change = late_axis(&world, &mut Random::seed_from_u64(1)).flux_nt;
        let is_changed = |k: usize| change.iter().any(|nt| nt[k] != 0.0);
        assert_eq!((0..3).filter(|&k| is_changed(k)).count(), 1);
    }
}
