//! The tows of the trial of contacts, each drawn from a seed.
//!
//! Three motions in turn: a lake tow, a sea tow, and a body that is carried over land and rocked as on the calibration,
//! which the simulator has as a third. Ten to thirty minutes each. Six of ten tows have lines with turns, the others one line
//! (on land always headings with turns). Six of ten have positions, two a speed alone, two neither; of the positions on water
//! one in five is the ship's, 20 to 60 m of cable ahead. Sensors, body, rock and
//! motion are half to twice those of the presets.
//!
//! Iron: 0 to 10 dipoles of 0.1 to 100 A m^2 (uniform in the logarithm) in any direction, 2 to 12 m away where they are
//! closest, anywhere along the track and on any side below the body. Two of them are never passed within the time that the
//! body takes for both their distances, and 5 s. How near iron may be to be told apart is asked by tows with groups: there half of
//! the dipoles have one to three more behind them along the track, each 1.5 to 5 times the mean of both distances further on.

use std::f64::consts::PI;

use host_sim::simulator::scenario::{Columns, DipoleSpec, Moment, Motion, Scenario, Ship, Simulation, Tow};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::receivers::Receiver;
use super::truth::{FAR_M, Pass, passes};

const LAND: &str = include_str!("../../../../scenarios/land_calibration.toml");
pub(crate) const LAKE: &str = include_str!("../../../../scenarios/lake_tow.toml");
pub(crate) const SEA: &str = include_str!("../../../../scenarios/sea_tow.toml");

/// Distance of the closest approach, m.
const DISTANCE_M: std::ops::RangeInclusive<f64> = 2.0..=12.0;

/// In groups: how far a dipole is behind the other, over the mean of both distances.
const APART: std::ops::Range<f64> = 1.5..5.0;
/// Iron lies no nearer to the ends of a tow, s.
const END_S: f64 = 20.0;

/// What a tow tells of where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Knows {
    Position,
    /// That of the ship, with the cable and the depth.
    Ship,
    Speed,
    Neither,
}

/// A tow of the trial.
pub(crate) struct Drawn {
    pub(crate) motion: &'static str,
    pub(crate) knows: Knows,
    pub(crate) scenario: Scenario,
    /// What gives the positions; without one they are true to a millimetre.
    pub(crate) receiver: Option<Receiver>,
}

/// The tow of a seed.
pub(crate) fn tow(seed: u64) -> Drawn {
    drawn(seed, false)
}

/// Another tow of a seed, with groups of iron.
pub(crate) fn tow_with_groups(seed: u64) -> Drawn {
    drawn(seed, true)
}

fn drawn(seed: u64, has_groups: bool) -> Drawn {
    // Apart from the streams that the simulator draws from the same seed.
    let mut draw = ChaCha8Rng::seed_from_u64(seed ^ 0x7472_6961_6c00_0000);
    let (motion, preset) = [("lake", LAKE), ("sea", SEA), ("land", LAND)][(seed % 3) as usize];
    let mut scenario = Scenario::parse(preset).unwrap();
    scenario.duration_s = draw.random_range(600.0_f64..1800.0).round();
    let knows = match draw.random_range(0..10) {
        0..6 => Knows::Position,
        6..8 => Knows::Speed,
        _ => Knows::Neither,
    };
    scenario.columns = Columns {
        position: knows == Knows::Position,
        speed: knows != Knows::Neither && draw.random_bool(0.5) || knows == Knows::Speed,
        attitude: draw.random_bool(0.5),
        line: draw.random_bool(0.5),
        depth: motion != "land" && draw.random_bool(0.5),
        ..Columns::default()
    };
    around(&mut scenario.scalar.noise_rms_nt, &mut draw);
    around(&mut scenario.fluxgate.noise_rms_nt, &mut draw);
    // The body on land is on its way, over rock like that below a lake.
    scenario.background.geology_rms_nt = scenario.background.geology_rms_nt.max(8.0);
    around(&mut scenario.background.geology_rms_nt, &mut draw);
    move_body(&mut scenario.motion, &mut draw);
    let mut std_nt = scenario.interference.uncompensated_std_nt.unwrap();
    around(&mut std_nt, &mut draw);
    scenario.interference.uncompensated_std_nt = Some(std_nt);
    let count = draw.random_range(0..=10);
    bury(&mut scenario, (count, has_groups), seed, &mut draw);
    let is_ship = knows == Knows::Position && motion != "land" && draw.random_bool(0.2);
    if is_ship {
        scenario.ship = Some(Ship { cable_out_m: draw.random_range(20.0_f64..60.0).round() });
        scenario.columns.depth = true;
    }
    Drawn { motion, knows: if is_ship { Knows::Ship } else { knows }, scenario, receiver: None }
}

/// Half to twice of it.
pub(crate) fn around(value: &mut f64, draw: &mut ChaCha8Rng) {
    *value *= 2.0_f64.powf(draw.random_range(-1.0..1.0));
}

fn move_body(motion: &mut Motion, draw: &mut ChaCha8Rng) {
    let (first, has_lines) = (draw.random_range(0.0..360.0), draw.random_bool(0.6));
    let lines = |tow: &mut Tow, draw: &mut ChaCha8Rng| {
        tow.first_heading_deg = first;
        tow.leg_s = if has_lines { draw.random_range(120.0..400.0) } else { 100_000.0 };
        (tow.turn_s, tow.turn_deg, tow.alternates) = (draw.random_range(30.0..60.0), 180.0, true);
        [&mut tow.roll_rms_deg, &mut tow.pitch_rms_deg, &mut tow.yaw_rms_deg]
            .into_iter()
            .for_each(|rms_deg| around(rms_deg, draw));
    };
    match motion {
        Motion::LakeTow { tow, speed_m_per_s, .. } => {
            lines(tow, draw);
            *speed_m_per_s = Some(draw.random_range(1.0..3.0));
        }
        Motion::SeaTow { tow, speed_m_per_s, significant_height_m, wave_from_deg, .. } => {
            lines(tow, draw);
            *speed_m_per_s = draw.random_range(1.0..3.0);
            *wave_from_deg = draw.random_range(0.0..360.0);
            around(significant_height_m, draw);
        }
        Motion::LandCalibration { first_heading_deg, leg_s, turn_s, speed_m_per_s, .. } => {
            *first_heading_deg = first;
            (*leg_s, *turn_s) = (draw.random_range(60.0..120.0), draw.random_range(10.0..20.0));
            *speed_m_per_s = Some(draw.random_range(0.8..1.5));
        }
    }
}

/// A dipole on its track.
struct Site {
    spec: DipoleSpec,
    passes: Vec<Pass>,
}

impl Site {
    /// `None` if the track comes nearer than it should, or nowhere near.
    fn of(bare: &Simulation, spec: DipoleSpec) -> Option<Self> {
        let mut passes = passes(bare.track(), &placed(bare, &spec));
        passes.retain(|pass| pass.distance_m <= FAR_M);
        let closest_m = passes.iter().map(|pass| pass.distance_m).fold(f64::INFINITY, f64::min);
        DISTANCE_M.contains(&closest_m).then_some(Self { spec, passes })
    }

    fn is_apart_from(&self, taken: &[Pass], speed_m_per_s: f64) -> bool {
        let is_apart =
            |a: &Pass, b: &Pass| (a.time_s - b.time_s).abs() >= (a.distance_m + b.distance_m) / speed_m_per_s + 5.0;
        self.passes.iter().all(|a| taken.iter().all(|b| is_apart(a, b)))
    }
}

/// Dipoles, each tried at up to 100 places until one is free; with or without others beside them.
fn bury(scenario: &mut Scenario, (count, has_groups): (usize, bool), seed: u64, draw: &mut ChaCha8Rng) {
    let (speed_m_per_s, duration_s) = (scenario.motion.speed_m_per_s().unwrap(), scenario.duration_s);
    // Without iron: the same track, but for iron that is seen from it.
    let bare = Simulation::new(scenario, seed).unwrap();
    let mut taken: Vec<Pass> = Vec::new();
    for _ in 0..count {
        let free = (0..100).find_map(|_| {
            let site = Site::of(&bare, dipole(duration_s, draw))?;
            site.is_apart_from(&taken, speed_m_per_s).then_some(site)
        });
        let Some(first) = free else { continue };
        let mut group = vec![first];
        let more = if has_groups && draw.random_bool(0.5) { draw.random_range(1..=3) } else { 0 };
        for _ in 0..more {
            let next = behind(&group[group.len() - 1].spec, (speed_m_per_s, duration_s), draw);
            let next = next.and_then(|spec| Site::of(&bare, spec));
            group.extend(next.filter(|site| site.is_apart_from(&taken, speed_m_per_s)));
        }
        taken.extend(group.iter().flat_map(|site| site.passes.iter().copied()));
        scenario.dipoles.extend(group.into_iter().map(|site| site.spec));
    }
}

/// A dipole behind another along the track; `None` where the tow ends before.
fn behind(other: &DipoleSpec, (speed_m_per_s, duration_s): (f64, f64), draw: &mut ChaCha8Rng) -> Option<DipoleSpec> {
    let spec = dipole(duration_s, draw);
    let distance_m = |spec: &DipoleSpec| spec.offset_m.unwrap().hypot(spec.below_m.unwrap());
    let apart_m = draw.random_range(APART) * 0.5 * (distance_m(other) + distance_m(&spec));
    let at_s = (other.at_s.unwrap() + apart_m / speed_m_per_s).round();
    (at_s <= duration_s - END_S).then_some(DipoleSpec { at_s: Some(at_s), ..spec })
}

fn dipole(duration_s: f64, draw: &mut ChaCha8Rng) -> DipoleSpec {
    let distance_m: f64 = draw.random_range(DISTANCE_M);
    // From port through straight below to starboard.
    let side: f64 = draw.random_range(-0.48 * PI..0.48 * PI);
    let size_am2 = 10.0_f64.powf(draw.random_range(-1.0..2.0));
    DipoleSpec {
        moment_am2: in_any_direction(size_am2, draw),
        inclination_deg: None,
        declination_deg: None,
        // Whole rows, and not where the recording begins or ends before the anomaly does.
        at_s: Some(draw.random_range(END_S..duration_s - END_S).round()),
        offset_m: Some(distance_m * side.sin()),
        below_m: Some(distance_m * side.cos()),
        latitude_deg: None,
        longitude_deg: None,
        depth_m: None,
    }
}

pub(crate) fn in_any_direction(size_am2: f64, draw: &mut ChaCha8Rng) -> Moment {
    let down: f64 = draw.random_range(-1.0..1.0);
    let (east, north) = draw.random_range(-PI..PI).sin_cos();
    let across = (1.0 - down * down).sqrt();
    Moment::Components([across * north, across * east, down].map(|part| size_am2 * part))
}

/// Where a dipole that is given by the track lies.
fn placed(simulation: &Simulation, spec: &DipoleSpec) -> [f64; 3] {
    let (track, row) = (simulation.track(), (spec.at_s.unwrap() * 10.0).round() as usize);
    let ([north_m, east_m, down_m], (sin, cos)) = (track.place_m[row], track.course[row].sin_cos());
    let offset_m = spec.offset_m.unwrap();
    [north_m - offset_m * sin, east_m + offset_m * cos, down_m + spec.below_m.unwrap()]
}

#[test]
fn tows_are_as_the_issue_asks() {
    let mut dipoles = 0;
    for seed in 1..=6 {
        let Drawn { motion, scenario, .. } = tow(seed);
        assert_eq!(motion, ["lake", "sea", "land"][(seed % 3) as usize]);
        let simulation = Simulation::new(&scenario, seed).unwrap();
        for dipole in &simulation.track().dipoles {
            let closest_m = passes(simulation.track(), &dipole.place_m)
                .iter()
                .map(|pass| pass.distance_m)
                .fold(f64::INFINITY, f64::min);
            let size = dipole.moment_am2.iter().map(|part| part * part).sum::<f64>().sqrt();
            assert!((1.99..12.01).contains(&closest_m) && (0.099..100.1).contains(&size), "{closest_m} {size}");
            dipoles += 1;
        }
    }
    assert!(dipoles > 6);
}
