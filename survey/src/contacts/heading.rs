//! The way by the fluxgate's heading, at the speed that positions have over a minute.
//!
//! Positions wander by tenths of a metre and more in the time of a pass; at 3 m that bends an anomaly by tenths of its peak.

use super::levelled::{Levelled, RATE_HZ};
use super::shape::{Shape, headings, step_m};
use super::way::{LEAST_SPEED_M_PER_S, Way};
use crate::navigation::Track;
use crate::statistics::bell_sums;

/// Spread of the bell over which a speed by positions is meant, s: the largest of which a minute is in full.
const STEADY_S: f64 = 20.0;

impl Way {
    /// `None` without positions, or where the fluxgate sees no heading.
    pub(super) fn by_heading(levelled: &Levelled<'_>) -> Option<Self> {
        let steps_m = steady_m(levelled.track?, &headings(levelled.direction)?)?;
        let on = |at: &mut f64, step_m: &f64| {
            *at += step_m;
            Some(*at)
        };
        let at: Vec<f64> = steps_m.iter().scan(0.0, on).collect();
        let per_s = steps_m.iter().map(|step_m| step_m * RATE_HZ).collect();
        let shape = Shape::of(&at, &Levelled { track: None, ..*levelled }, true);
        Some(Self { at, per_s, is_metres: true, shape })
    }
}

/// The way of every row since the one before, at a steady speed, m. `None` if the body went nowhere.
fn steady_m(track: &Track, headings: &[[f64; 2]]) -> Option<Vec<f64>> {
    let steps = (0..headings.len()).map(|row| Some(along(headings[row], step_m(track, row)?)));
    let steps_m: Vec<Option<[f64; 2]>> = steps.collect();
    let known = || steps_m.iter().flatten();
    // Magnetic north is not the grid's, and a body may head beside its way.
    let sums = known().fold([0.0; 2], |sums, step_m| [sums[0] + step_m[0], sums[1] + step_m[1]]);
    let size = sums[0].hypot(sums[1]);
    let forward = |step_m: &[f64; 2]| [(step_m[0] * sums[0] + step_m[1] * sums[1]) / size, 1.0];
    let forward: Vec<[f64; 2]> = steps_m.iter().map(|step_m| step_m.as_ref().map_or([0.0; 2], forward)).collect();
    let (mean, least) = (size / known().count() as f64, LEAST_SPEED_M_PER_S / RATE_HZ);
    let steady = |[sum, count]: [f64; 2]| if count > 0.0 { (sum / count).max(least) } else { mean };
    (size > 0.0).then(|| bell_sums(&forward, STEADY_S * RATE_HZ).map(steady).collect())
}

/// The parts of a step, east and north, along a heading and across it.
fn along([east, north]: [f64; 2], step_m: [f64; 2]) -> [f64; 2] {
    [step_m[0] * east + step_m[1] * north, step_m[0] * north - step_m[1] * east]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::dipole::{Dipole, profiles};
    use crate::contacts::levelled::WayBy;
    use crate::contacts::{Options, find, find_again};

    const SPEED_M_PER_S: f64 = 1.5;

    /// Straight to 10 degrees by east of magnetic north, as positions see it that wander by so much in 9 s.
    fn track(rows: usize, wander_m: f64) -> Track {
        let course = 10_f64.to_radians();
        let place = |k: usize, part: f64, late: f64| {
            let s = k as f64 / RATE_HZ;
            SPEED_M_PER_S * s * part + wander_m * (std::f64::consts::TAU * s / 9.0 + late).sin()
        };
        let easting_m: Vec<f64> = (0..rows).map(|k| 5e5 + place(k, course.sin(), 0.0)).collect();
        let northing_m: Vec<f64> = (0..rows).map(|k| 6e6 + place(k, course.cos(), 1.0)).collect();
        let step = |k: usize| (easting_m[k] - easting_m[k - 1]).hypot(northing_m[k] - northing_m[k - 1]);
        let along_m = (0..rows).scan(0.0, |at, k| {
            *at += if k > 0 { step(k) } else { 0.0 };
            Some(*at)
        });
        let (along_m, course_deg) = (along_m.collect(), vec![10.0; rows]);
        Track { along_m, course_deg, easting_m, northing_m, ..Track::default() }
    }

    fn levelled<'a>(
        (time_s, field_nt): (&'a [f64], &'a [f64]),
        track: Option<&'a Track>,
        direction: &'a [[f64; 3]],
        (is_valid, terms): (&'a [bool], &'a [[f64; 18]]),
    ) -> Levelled<'a> {
        let (variance_nt2, altitude_m, depth_m) = (None, None, None);
        Levelled { time_s, is_valid, field_nt, variance_nt2, terms, direction, track, altitude_m, depth_m }
    }

    fn times(rows: usize) -> Vec<f64> {
        (0..rows).map(|row| row as f64 / RATE_HZ).collect()
    }

    #[test]
    fn positions_that_wander_bend_the_way_and_a_heading_does_not() {
        let (time_s, track, direction) = (times(2_000), track(2_000, 0.3), vec![[0.6, 0.0, 0.8]; 2_000]);
        let levelled = levelled((&time_s, &[]), Some(&track), &direction, (&[], &[]));
        assert!(Way::by_heading(&levelled).is_some());
        assert!(Way::by_heading(&Levelled { track: None, ..levelled }).is_none());
        let [by_positions, by_heading] = [WayBy::Positions, WayBy::Heading].map(|way_by| Way::by(way_by, &levelled));
        let off = |way: &Way| way.per_s.iter().map(|speed| (speed / SPEED_M_PER_S - 1.0).abs()).fold(0.0, f64::max);
        assert!(off(&by_positions) > 0.1 && off(&by_heading) < 0.02, "{} {}", off(&by_positions), off(&by_heading));
        let is_bent = |way: &Way| way.is_bent_at(way.at[1_000], 3.0);
        assert!(is_bent(&by_positions) && !is_bent(&by_heading));

        let dipole = Dipole { at: by_positions.at[700] + 0.01, distance: 3.0, side_rad: 0.2, amplitudes_nt: [1.0; 3] };
        let other = by_heading.taken_over(&dipole, &by_positions);
        let seconds = |way: &Way, dipole: &Dipole| dipole.distance / way.per_s[way.row_at(dipole.at)];
        assert!(by_heading.row_at(other.at).abs_diff(701) <= 1, "{}", by_heading.row_at(other.at));
        assert!((seconds(&by_heading, &other) / seconds(&by_positions, &dipole) - 1.0).abs() < 1e-3);
    }

    /// Where positions are missing the speed is that around them, and where they are for long that of all.
    #[test]
    fn without_positions_for_a_while_the_body_goes_on() {
        let (time_s, direction) = (times(4_000), vec![[0.6, 0.0, 0.8]; 4_000]);
        let mut track = track(4_000, 0.0);
        track.easting_m[500..700].fill(f64::NAN);
        track.easting_m[1_500..3_500].fill(f64::NAN);
        let way = Way::by(WayBy::Heading, &levelled((&time_s, &[]), Some(&track), &direction, (&[], &[])));
        assert!(way.per_s.iter().all(|speed| (speed / SPEED_M_PER_S - 1.0).abs() < 1e-6));
    }

    /// Three pieces of strong iron on a straight way.
    #[test]
    fn strong_iron_tells_that_positions_wander() {
        let rows = 6_000;
        let (time_s, direction) = (times(rows), vec![[0.6, 0.0, 0.8]; rows]);
        let noise_nt = |row: usize| 0.05 * ((row * 7_919 % 1_009) as f64 / 1_009.0 - 0.5);
        let iron_nt = |s: f64| [150.0, 300.0, 450.0].map(|at| 300.0 * profiles((s - at) / 3.0)[0]).iter().sum::<f64>();
        let field_nt: Vec<f64> = (0..rows).map(|row| 5e4 + iron_nt(time_s[row]) + noise_nt(row)).collect();
        let (is_valid, terms) = (vec![true; rows], vec![[0.0; 18]; rows]);
        let told_by = |wander_m: f64| {
            let track = track(rows, wander_m);
            let levelled = levelled((&time_s, &field_nt), Some(&track), &direction, (&is_valid, &terms));
            let first = find(&levelled, &Options::default());
            let again = find_again(&levelled, &Options::default(), &first);
            (again.way_by, again.passes.len())
        };
        assert_eq!(told_by(0.3), (WayBy::Heading, 3));
    }
}
