//! From a scenario to a recording.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use towmag::filter::{BandPassDesign, BandPassState};
use towmag::model::TERMS;

use super::earth::Slow;
use super::noise::noise_nt;
use super::path::Path;
use super::place::Track;
use super::{Current, Interval, Scenario, Ship};
use crate::effects::Request;
use crate::effects::{Draw, Readings};
use crate::recording::RATE_HZ;
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
        world.coefficients = scenario.coefficients(&world, seed);
        let points: Vec<usize> = world.epochs_s.iter().map(|&time_s| grid.nearest(time_s)).collect();
        let track = Track::new(scenario, scenario.field.resolve()?.direction, &path, points.iter().copied(), &grid);
        add_dipoles(&mut world, &path, &track);
        let signals = Signals::new(world);
        let attitude = points.iter().map(|&point| path.attitude[point]).collect();
        let ship_m = scenario.ship.map(|ship| points.iter().map(|&point| ship.place_m(&path, point, &grid)).collect());
        let line = signals.epochs_s().iter().map(|&time_s| label(&path, time_s)).collect();
        let valid = (0..signals.len()).map(|row| scenario.is_valid(&signals, row)).collect();
        Ok(Self { scenario: scenario.clone(), seed, signals, attitude, track, ship_m, line, valid })
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

    /// What the sensors say while some effects are at work: each changes the clean signal, and the changes add.
    pub fn record(&self, effects: &[Request]) -> Recorded<'_> {
        let rows = self.signals.rows();
        let mut readings = Readings { scalar_nt: rows.scalar_nt.clone(), flux_nt: rows.flux_nt.clone() };
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
    fn world(&self, grid: &Grid, path: &Path, epochs_s: Vec<f64>, seed: u64) -> Result<Trajectory, String> {
        let earth = self.field.resolve()?;
        let slow = Slow::new(&self.background, &self.targets, &mut stream(seed, Stream::Geology, 0));
        let by_row = |values: &Vec<f64>| epochs_s.iter().map(|&time_s| grid.at(values, time_s)).collect();
        Ok(Trajectory {
            rate_hz: grid.rate_hz,
            start_s: grid.start_s,
            field_nt: (0..grid.len).map(|point| earth.strength_nt + slow.at(grid.time_s(point))).collect(),
            direction: path.attitude.iter().map(|attitude| attitude.to_body(earth.direction)).collect(),
            coefficients: [0.0; TERMS],
            first_row_time_s: self.first_time_s,
            depth_m: path.depth_m.as_ref().map(by_row),
            temperature_deg_c: self.temperature.as_ref().map(|t| epochs_s.iter().map(|&time_s| t.at(time_s)).collect()),
            currents_a: self.currents.iter().map(|c| (c.name.clone(), c.by_row(&epochs_s))).collect(),
            epochs_s,
        })
    }

    /// The coefficients: given or drawn, scaled to the uncompensated standard deviation if there is one.
    fn coefficients(&self, world: &Trajectory, seed: u64) -> [f64; TERMS] {
        let source = &self.interference;
        let unscaled = source.coefficients.unwrap_or_else(|| drawn(&mut stream(seed, Stream::Interference, 0)));
        let Some(asked_nt) = source.uncompensated_std_nt else { return unscaled };
        let signals = Signals::new(Trajectory { coefficients: unscaled, ..world.clone() });
        let found_nt = band_passed_std_nt(signals.rows().interference.iter().map(|parts| parts.total_nt()));
        // A body that never moves has no interference in the band, however strong.
        let scale = if found_nt > 0.0 { asked_nt / found_nt } else { 1.0 };
        unscaled.map(|coefficient| scale * coefficient)
    }

    fn is_valid(&self, signals: &Signals, row: usize) -> bool {
        let time_s = signals.epochs_s()[row];
        let dropped = self.dropouts.iter().any(|dropout| dropout.contains(time_s));
        !dropped && self.dead_zone.as_ref().is_none_or(|zone| !zone.holds(signals.rows().direction[row]))
    }
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

/// Terms of the size that a steel-framed body has: tens of nT, parts in a hundred of the field, milliseconds.
fn drawn(draw: &mut Draw) -> [f64; TERMS] {
    let mut gauss = |rms: f64| -> f64 {
        let unit: f64 = StandardNormal.sample(draw);
        rms * unit
    };
    std::array::from_fn(|term| match term {
        0..3 => gauss(50.0),
        3..9 => gauss(0.004),
        _ => gauss(0.003),
    })
}

/// Standard deviation in the band of the published method, 0.1 to 0.9 Hz, by the core's own filter, nT.
pub(crate) fn band_passed_std_nt(values_nt: impl Iterator<Item = f64>) -> f64 {
    let band_pass = BandPassDesign::default().build().expect("the default is a valid design");
    let mut state = None;
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value_nt in values_nt {
        let input = [value_nt as f32];
        let state = state.get_or_insert_with(|| BandPassState::steady(&input));
        let [passed] = band_pass.step(state, &input).map(f64::from);
        (count, sum, squares) = (count + 1.0, sum + passed, squares + passed * passed);
    }
    let mean = sum / count;
    (squares / count - mean * mean).max(0.0).sqrt()
}

/// Iron adds its vector to the Earth's: both sensors see their sum, the scalar its size.
fn add_dipoles(world: &mut Trajectory, path: &Path, track: &Track) {
    if track.dipoles.is_empty() {
        return;
    }
    for (point, (field_nt, direction)) in world.field_nt.iter_mut().zip(&mut world.direction).enumerate() {
        let place_m = path.at_point(point);
        let mut sum_nt = track.earth.map(|component| component * *field_nt);
        for dipole in &track.dipoles {
            let iron_nt = dipole.field_nt(place_m);
            (0..3).for_each(|i| sum_nt[i] += iron_nt[i]);
        }
        *field_nt = sum_nt.iter().map(|nt| nt * nt).sum::<f64>().sqrt();
        *direction = path.attitude[point].to_body(sum_nt.map(|nt| nt / *field_nt));
    }
}

impl Ship {
    /// The body follows in the ship's wake, as far behind as the straight cable reaches at its depth.
    fn place_m(&self, path: &Path, point: usize, grid: &Grid) -> [f64; 2] {
        let [.., depth_m] = path.at_point(point);
        let behind_m = (self.cable_out_m * self.cable_out_m - depth_m * depth_m).max(0.0).sqrt();
        let mut at = point;
        let mut way_m = 0.0;
        let step_m = |at: usize| {
            let [a, b] = [path.place_m[at], path.place_m[at + 1]];
            libm::hypot(b[0] - a[0], b[1] - a[1])
        };
        while at + 1 < grid.len && way_m < behind_m {
            way_m += step_m(at);
            at += 1;
        }
        // Beyond the end of the physics the ship goes straight on.
        let (sin, cos) = libm::sincos(path.course.heading_deg(grid.time_s(at)).to_radians());
        [path.place_m[at][0] + (behind_m - way_m) * cos, path.place_m[at][1] + (behind_m - way_m) * sin]
    }
}

/// `leg1`, `turn1`, `leg2` and so on.
fn label(path: &Path, time_s: f64) -> String {
    let course = &path.course;
    let leg = course.leg(time_s);
    let into_s = time_s - leg * (course.leg_s + course.turn_s);
    let kind = if into_s < course.leg_s { "leg" } else { "turn" };
    format!("{kind}{:.0}", leg + 1.0)
}
