//! Attitude and depth of the body over time.

use std::f64::consts::{PI, TAU};

use rand::RngExt;

use super::waves::{Met, Sea};
use super::{Motion, Tow};
use crate::effects::Draw;
use crate::simulator::signals::Grid;
use crate::simulator::{Attitude, Course, Oscillation};

/// What the body does on the dense grid.
pub(super) struct Path {
    pub(super) attitude: Vec<Attitude>,
    /// North and east of the place of the first row, m; where no speed is known the body stays.
    pub(super) place_m: Vec<[f64; 2]>,
    /// Depth, m; on land there is none.
    pub(super) depth_m: Option<Vec<f64>>,
    /// Legs and turns, for the labels.
    pub(super) course: Course,
}

/// Sines of a rocking that a hand keeps nearly regular.
const ROCKING_SINES: usize = 3;
/// Relative spread of the rocking's frequency.
const ROCKING_SPREAD: f64 = 0.15;
/// Sines of a body's swing on its cable.
const SWING_SINES: usize = 14;
/// How fast it is shaken, Hz.
const SHAKE_HZ: f64 = 1.0;
/// Periods of the slow change of depth on a lake, s.
const DEPTH_PERIODS_S: [f64; 2] = [60.0, 12.0];

impl Path {
    /// North, east, down, m, at a point of the grid.
    pub(super) fn at_point(&self, point: usize) -> [f64; 3] {
        let [north_m, east_m] = self.place_m[point];
        [north_m, east_m, self.depth_m.as_ref().map_or(0.0, |depth_m| depth_m[point])]
    }
}

impl Motion {
    pub(super) fn path(&self, grid: &Grid, draw: &mut Draw) -> Path {
        let mut path = self.turning(grid, draw);
        path.place_m = along(&path.course, self.speed_m_per_s().unwrap_or(0.0), grid);
        path
    }

    /// Attitude and depth alone.
    fn turning(&self, grid: &Grid, draw: &mut Draw) -> Path {
        match self {
            Self::LandCalibration { .. } => self.on_land(grid, draw),
            Self::LakeTow { tow, longest_period_s, shortest_period_s, depth_rms_m, .. } => {
                let band = [1.0 / longest_period_s, 1.0 / shortest_period_s];
                on_lake(tow, band, *depth_rms_m, grid, draw)
            }
            Self::SeaTow {
                tow,
                spectrum,
                significant_height_m,
                peak_period_s,
                wave_from_deg,
                speed_m_per_s,
                heave_per_wave,
            } => {
                let sea = Sea::new(*spectrum, *significant_height_m, *peak_period_s, *wave_from_deg, draw);
                on_sea(tow, &sea, *speed_m_per_s, *heave_per_wave, grid)
            }
        }
    }

    fn on_land(&self, grid: &Grid, draw: &mut Draw) -> Path {
        let &Self::LandCalibration {
            headings,
            first_heading_deg,
            leg_s,
            turn_s,
            roll_rms_deg,
            pitch_rms_deg,
            yaw_rms_deg,
            rocking_period_s,
            shake_rms_deg,
            shake_s,
            ..
        } = self
        else {
            unreachable!("asked for on land alone")
        };
        let course =
            Course { first_heading_deg, leg_s, turn_s, turn_deg: 360.0 / f64::from(headings), alternates: false };
        let band = [(1.0 - ROCKING_SPREAD) / rocking_period_s, (1.0 + ROCKING_SPREAD) / rocking_period_s];
        let rocking = [roll_rms_deg, pitch_rms_deg, yaw_rms_deg]
            .map(|rms_deg| Oscillation::random(rms_deg, band[0], band[1], ROCKING_SINES, draw));
        let phases: [f64; 3] = std::array::from_fn(|_| TAU * draw.random::<f64>());
        let shake = shake_rms_deg.to_radians() * std::f64::consts::SQRT_2;
        let rocked_s = leg_s - shake_s;
        let attitude = times(grid).map(|time_s| {
            let into_leg_s = time_s - course.leg(time_s) * (leg_s + turn_s);
            let angle = |axis: usize| {
                // One axis after the other, then all at once; smooth at both ends.
                let third = rocked_s / 3.0;
                let rocked = window((into_leg_s - axis as f64 * third) / third) * rocking[axis].angle(time_s);
                let shaken = shake * libm::sin(TAU * SHAKE_HZ * time_s + phases[axis]);
                if shake_s > 0.0 { rocked + window((into_leg_s - rocked_s) / shake_s) * shaken } else { rocked }
            };
            let heading = course.heading_deg(time_s).to_radians() + angle(2);
            Attitude { roll: angle(0), pitch: angle(1), heading }
        });
        Path { attitude: attitude.collect(), place_m: Vec::new(), depth_m: None, course }
    }
}

impl Tow {
    fn course(&self) -> Course {
        let Self { first_heading_deg, leg_s, turn_s, turn_deg, alternates, .. } = *self;
        Course { first_heading_deg, leg_s, turn_s, turn_deg, alternates }
    }

    fn axes_rms_deg(&self) -> [f64; 3] {
        [self.roll_rms_deg, self.pitch_rms_deg, self.yaw_rms_deg]
    }
}

fn on_lake(tow: &Tow, [low_hz, high_hz]: [f64; 2], depth_rms_m: f64, grid: &Grid, draw: &mut Draw) -> Path {
    let course = tow.course();
    let swing = tow.axes_rms_deg().map(|rms_deg| Oscillation::random(rms_deg, low_hz, high_hz, SWING_SINES, draw));
    let [longest_s, shortest_s] = DEPTH_PERIODS_S;
    // An oscillation in radians from degrees: metres in, metres out.
    let rms = depth_rms_m.to_degrees();
    let bobbing = Oscillation::random(rms, 1.0 / longest_s, 1.0 / shortest_s, SWING_SINES, draw);
    let attitude = times(grid).map(|time_s| Attitude {
        roll: swing[0].angle(time_s),
        pitch: swing[1].angle(time_s),
        heading: course.heading_deg(time_s).to_radians() + swing[2].angle(time_s),
    });
    let depth_m = times(grid).map(|time_s| tow.depth_m + bobbing.angle(time_s)).collect();
    Path { attitude: attitude.collect(), place_m: Vec::new(), depth_m: Some(depth_m), course }
}

fn on_sea(tow: &Tow, sea: &Sea, speed_m_per_s: f64, heave_per_wave: f64, grid: &Grid) -> Path {
    let course = tow.course();
    let mut place_m = [0.0, 0.0];
    let met: Vec<(f64, Met)> = times(grid)
        .map(|time_s| {
            let heading = course.heading_deg(time_s).to_radians();
            let (sin, cos) = libm::sincos(heading);
            let met = sea.meet(time_s, place_m, heading);
            place_m[0] += speed_m_per_s * cos / grid.rate_hz;
            place_m[1] += speed_m_per_s * sin / grid.rate_hz;
            (heading, met)
        })
        .collect();
    // The sea gives the shape of the motion, the scenario its size: how a body answers depends on wing and cable.
    let scale = |rms_deg: f64, of: fn(&Met) -> f64| {
        let mean_square = met.iter().map(|(_, met)| of(met) * of(met)).sum::<f64>() / met.len() as f64;
        if mean_square > 0.0 { rms_deg.to_radians() / mean_square.sqrt() } else { 0.0 }
    };
    let [roll_rms_deg, pitch_rms_deg, yaw_rms_deg] = tow.axes_rms_deg();
    let roll = scale(roll_rms_deg, |met| met.slope_starboard);
    let pitch = scale(pitch_rms_deg, |met| met.slope_ahead);
    let yaw = scale(yaw_rms_deg, |met| met.sway);
    let attitude = met.iter().map(|(heading, met)| Attitude {
        roll: -roll * met.slope_starboard,
        pitch: pitch * met.slope_ahead,
        heading: heading + yaw * met.sway,
    });
    let depth_m = met.iter().map(|(_, met)| tow.depth_m - heave_per_wave * met.elevation_m).collect();
    Path { attitude: attitude.collect(), place_m: Vec::new(), depth_m: Some(depth_m), course }
}

/// The way along a course at a speed, m north and east, from the point at the time 0: by the trapezoidal rule, whose
/// error is 1e-7 of the way in a turn of ten seconds at 100 points a second.
fn along(course: &Course, speed_m_per_s: f64, grid: &Grid) -> Vec<[f64; 2]> {
    let step_m = 0.5 * speed_m_per_s / grid.rate_hz;
    let mut place_m = [0.0; 2];
    let mut before: Option<(f64, f64)> = None;
    let mut all: Vec<[f64; 2]> = times(grid)
        .map(|time_s| {
            let (sin, cos) = libm::sincos(course.heading_deg(time_s).to_radians());
            if let Some((sin_before, cos_before)) = before.replace((sin, cos)) {
                place_m = [place_m[0] + step_m * (cos + cos_before), place_m[1] + step_m * (sin + sin_before)];
            }
            place_m
        })
        .collect();
    let first_m = all[grid.nearest(0.0)];
    all.iter_mut().for_each(|place_m| *place_m = [place_m[0] - first_m[0], place_m[1] - first_m[1]]);
    all
}

fn times(grid: &Grid) -> impl Iterator<Item = f64> {
    let grid = *grid;
    (0..grid.len).map(move |point| grid.time_s(point))
}

/// 0 outside 0 to 1, smooth in between and at the ends up to the third derivative: a hand does not set in with a jerk.
fn window(x: f64) -> f64 {
    let share = if (0.0..=1.0).contains(&x) { libm::sin(PI * x).powi(2) } else { 0.0 };
    share * share * (3.0 - 2.0 * share)
}
