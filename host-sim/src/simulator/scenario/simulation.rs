//! From a scenario to a recording.

use rand::SeedableRng;

use super::earth::Slow;
use super::noise::noise_nt;
use super::path::Path;
use super::place::Track;
use super::{Current, Interval, Scenario, SecondScalar};
use crate::effects::Request;
use crate::effects::{Draw, Readings};
use crate::recording::{Column, RATE_HZ};
use crate::simulator::Attitude;
use crate::simulator::signals::{Grid, Signals, Trajectory};

/// Points of the physics in a second.
const GRID_RATE_HZ: f64 = 100.0;
/// Physics before the first row and after the last, s: what lags and filters look back on.
const MARGIN_S: f64 = 20.0;

/// What is random has a stream of its own, so that an effect more leaves the noise as it is.
#[derive(Clone, Copy)]
enum Stream {
    Motion = 1,
    Geology,
    Interference,
    ScalarNoise,
    FluxgateNoise,
    /// And one more for each effect.
    Effects,
    SecondBody = 1000,
    SecondNoise,
}

/// A scenario that has been played: the clean world, ready for effects and noise.
#[derive(Debug)]
pub struct Simulation {
    scenario: Scenario,
    seed: u64,
    signals: Signals,
    attitude: Vec<Attitude>,
    track: Track,
    ship_m: Option<Vec<[f64; 2]>>,
    /// What a second scalar sensor would read without noise, nT, one a row.
    second_nt: Option<Vec<f64>>,
    line: Vec<String>,
    valid: Vec<bool>,
}

/// What the sensors say, and what belongs to it.
#[derive(Debug)]
pub struct Recorded<'a> {
    /// What it was made from.
    pub simulation: &'a Simulation,
    /// The readings, one a row, as the sensors resolve them; not a number where the body has none.
    pub readings: Readings,
    /// Whether they are what the body's drivers have read.
    pub(super) is_sensed: bool,
}

impl Simulation {
    /// Play a scenario. The error is one line: where, what, what to do.
    pub fn new(scenario: &Scenario, seed: u64) -> Result<Self, String> {
        scenario.check()?;
        let grid = grid(scenario.duration_s);
        let epochs_s = epochs_s(scenario.duration_s, &scenario.gaps);
        if epochs_s.is_empty() {
            return Err("gap: nothing is left between the gaps".into());
        }
        let path = scenario.motion.path(&grid, &mut stream(seed, Stream::Motion, 0));
        let mut world = scenario.world(&grid, &path, epochs_s, seed)?;
        // Before the iron is there: the body is the same with it and without.
        let coefficients = scenario.interference.of_body(&world, &mut stream(seed, Stream::Interference, 0));
        let points: Vec<usize> = world.epochs_s.iter().map(|&time_s| grid.nearest(time_s)).collect();
        let earth = scenario.field.resolve()?;
        let track = Track::new(scenario, earth.direction, &path, points.iter().copied(), &grid);
        track.add_dipoles(&mut world, &path);
        let attitude: Vec<Attitude> = points.iter().map(|&point| path.attitude[point]).collect();
        world.columns = attitude_columns(&attitude);
        let signals = Signals::new(world, coefficients);
        let ship_m = scenario.ship.map(|ship| points.iter().map(|&point| ship.place_m(&path, point, &grid)).collect());
        let slow = scenario.slow(seed);
        let second = |second: &SecondScalar| {
            let draw = &mut stream(seed, Stream::SecondBody, 0);
            second.reads_nt(scenario, &slow, &signals, (&track, &attitude), earth.strength_nt, draw)
        };
        let second_nt = scenario.scalar2.as_ref().map(second);
        let line = signals.epochs_s().iter().map(|&time_s| label(&path, time_s)).collect();
        let valid = (0..signals.len()).map(|row| scenario.is_valid(&signals, row)).collect();
        Ok(Self { scenario: scenario.clone(), seed, signals, attitude, track, ship_m, second_nt, line, valid })
    }

    /// The clean world.
    pub fn signals(&self) -> &Signals {
        &self.signals
    }

    /// What it was made from.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Attitude, one a row.
    pub fn attitude(&self) -> &[Attitude] {
        &self.attitude
    }

    /// Where the body is, and what it passes.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// Where the ship is, m north and east of the body's first row, one a row, if there is one.
    pub fn ship_m(&self) -> Option<&[[f64; 2]]> {
        self.ship_m.as_deref()
    }

    /// Label of the leg or turn, one a row.
    pub fn line(&self) -> &[String] {
        &self.line
    }

    /// Whether the scalar sensor says that its reading is valid, one a row.
    pub fn valid(&self) -> &[bool] {
        &self.valid
    }

    /// What the second scalar sensor says, nT, one a row, if there is one; effects are the first one's.
    pub fn second_nt(&self) -> Option<Vec<f64>> {
        let (clean_nt, second) = self.second_nt.as_ref().zip(self.scenario.scalar2.as_ref())?;
        let noise = noise_nt(&second.sensor, clean_nt.len(), &mut stream(self.seed, Stream::SecondNoise, 0));
        let step_nt = second.sensor.resolution_nt;
        let reads = |(clean_nt, noise_nt): (&f64, f64)| ((clean_nt + noise_nt) / step_nt).round() * step_nt;
        Some(clean_nt.iter().zip(noise).map(reads).collect())
    }

    /// What the sensors say while some effects are at work: each changes the clean signal, and the changes add.
    pub fn record(&self, effects: &[Request]) -> Recorded<'_> {
        let (scalar_nt, flux_nt) = (self.signals.scalar_at_rows_nt().to_vec(), self.signals.rows().flux_nt.clone());
        let mut readings = Readings { scalar_nt, flux_nt };
        let mut draws: Vec<_> = (0..).map(|k| stream(self.seed, Stream::Effects, k)).take(effects.len()).collect();
        for (request, draw) in effects.iter().zip(&mut draws) {
            readings.add(&request.effect.change(&self.signals, &request.parameters, draw));
        }
        self.add_noise(&mut readings);
        for (request, draw) in effects.iter().zip(&mut draws) {
            request.effect.after_noise(&self.signals, &request.parameters, &mut readings, draw);
        }
        let round = |nt: &mut f64, step_nt: f64| *nt = (*nt / step_nt).round() * step_nt;
        readings.scalar_nt.iter_mut().for_each(|nt| round(nt, self.scenario.scalar.resolution_nt));
        readings.flux_nt.iter_mut().flatten().for_each(|nt| round(nt, self.scenario.fluxgate.resolution_nt));
        Recorded { simulation: self, readings, is_sensed: false }
    }

    fn add_noise(&self, readings: &mut Readings) {
        let rows = self.signals.len();
        let noise = noise_nt(&self.scenario.scalar, rows, &mut stream(self.seed, Stream::ScalarNoise, 0));
        readings.scalar_nt.iter_mut().zip(noise).for_each(|(reading, noise)| *reading += noise);
        let mut draw = stream(self.seed, Stream::FluxgateNoise, 0);
        for axis in 0..3 {
            let noise = noise_nt(&self.scenario.fluxgate, rows, &mut draw);
            readings.flux_nt.iter_mut().zip(noise).for_each(|(reading, noise)| reading[axis] += noise);
        }
    }
}

impl Scenario {
    fn slow(&self, seed: u64) -> Slow {
        Slow::new(&self.background, &self.targets, &mut stream(seed, Stream::Geology, 0))
    }

    fn world(&self, grid: &Grid, path: &Path, epochs_s: Vec<f64>, seed: u64) -> Result<Trajectory, String> {
        let earth = self.field.resolve()?;
        let slow = self.slow(seed);
        let by_row = |values: &Vec<f64>| epochs_s.iter().map(|&time_s| grid.at(values, time_s)).collect();
        Ok(Trajectory {
            rate_hz: grid.rate_hz,
            start_s: grid.start_s,
            field_nt: (0..grid.len).map(|point| earth.strength_nt + slow.at(grid.time_s(point))).collect(),
            direction: path.attitude.iter().map(|attitude| attitude.to_body(earth.direction)).collect(),
            first_row_time_s: self.first_time_s,
            depth_m: path.depth_m.as_ref().map(by_row),
            temperature_deg_c: self.temperature.as_ref().map(|t| epochs_s.iter().map(|&time_s| t.at(time_s)).collect()),
            currents_a: self.currents.iter().map(|c| (c.name.clone(), c.by_row(&epochs_s))).collect(),
            columns: Vec::new(),
            epochs_s,
        })
    }

    fn is_valid(&self, signals: &Signals, row: usize) -> bool {
        let time_s = signals.epochs_s()[row];
        let dropped = self.dropouts.iter().any(|dropout| dropout.contains(time_s));
        !dropped && self.dead_zone.as_ref().is_none_or(|zone| !zone.holds(signals.rows().direction[row]))
    }
}

/// Roll, pitch and heading as a recording has them.
fn attitude_columns(attitude: &[Attitude]) -> Vec<(String, Vec<f64>)> {
    let column = |column: Column, of: fn(&Attitude) -> f64| {
        (column.name().to_string(), attitude.iter().map(|attitude| of(attitude).to_degrees()).collect::<Vec<f64>>())
    };
    let mut columns = vec![
        column(Column::Roll, |attitude| attitude.roll),
        column(Column::Pitch, |attitude| attitude.pitch),
        column(Column::Heading, |attitude| attitude.heading),
    ];
    columns[2].1.iter_mut().for_each(|deg| *deg = deg.rem_euclid(360.0));
    columns
}

impl super::FlaggedZone {
    fn holds(&self, c: [f64; 3]) -> bool {
        let (sin_azimuth, cos_azimuth) = libm::sincos(self.axis_azimuth_deg.to_radians());
        let (sin_elevation, cos_elevation) = libm::sincos(self.axis_elevation_deg.to_radians());
        let along = cos_elevation * (c[0] * cos_azimuth + c[1] * sin_azimuth) + c[2] * sin_elevation;
        along.abs() >= libm::cos(self.half_angle_deg.to_radians())
    }
}

impl super::Temperature {
    fn at(&self, time_s: f64) -> f64 {
        self.final_deg_c + (self.first_deg_c - self.final_deg_c) * libm::exp(-time_s / self.time_constant_s)
    }
}

impl Current {
    fn by_row(&self, epochs_s: &[f64]) -> Vec<f64> {
        let at = |time_s: &f64| {
            let cycles = time_s / self.period_s + self.phase;
            if cycles - cycles.floor() < self.duty { self.on_a } else { self.off_a }
        };
        epochs_s.iter().map(at).collect()
    }
}

fn stream(seed: u64, stream: Stream, offset: u64) -> Draw {
    let mut draw = Draw::seed_from_u64(seed);
    draw.set_stream(stream as u64 + offset);
    draw
}

fn grid(duration_s: f64) -> Grid {
    let len = ((duration_s + 2.0 * MARGIN_S) * GRID_RATE_HZ).ceil() as usize + 1;
    Grid { rate_hz: GRID_RATE_HZ, start_s: -MARGIN_S, len }
}

/// Times of the rows, s; the first is 0 whatever the gaps.
fn epochs_s(duration_s: f64, gaps: &[Interval]) -> Vec<f64> {
    let count = (duration_s * RATE_HZ).round() as u32;
    let all = (0..count).map(|tick| f64::from(tick) / RATE_HZ);
    all.filter(|&time_s| time_s == 0.0 || !gaps.iter().any(|gap| gap.contains(time_s))).collect()
}

/// `leg1`, `turn1`, `leg2` and so on.
fn label(path: &Path, time_s: f64) -> String {
    let course = &path.course;
    let leg = course.leg(time_s);
    let into_s = time_s - leg * (course.leg_s + course.turn_s);
    let kind = if into_s < course.leg_s { "leg" } else { "turn" };
    format!("{kind}{:.0}", leg + 1.0)
}
