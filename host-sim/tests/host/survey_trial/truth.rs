//! What is true of a made tow: when each dipole is passed, how far away, and how far it stands out of the noise.
//!
//! A pass is a row whose distance to the dipole is the smallest within 10 s to either side, and 30 m at most. Its signal is the change of the
//! size of the Earth's field along the body's way, from half the time to the pass before to half the time to the next. Its
//! signal to noise is that of the matched filter, `sqrt(sum_k |A_k|^2 / (N S_k))`, A the discrete Fourier transform of the
//! signal over its N rows, S the spectrum of a row, of
//!
//! - the scalar sensor's noise in its colour, and of the resolution that it rounds to;
//! - the rock along the track. Its sines have periods that are uniform in their logarithm and powers that go with them: over
//!   all draws that is a spectrum of `rms^2 / (19 P f^2)` from `1 / 20 P` to `1 / P`, P the shortest period, and none outside.
//!
//! What is slower than the slowest rock counts for nothing, for no recording tells the level. The body's own field and the
//! fluxgate's noise are left out: this is the bound of a survey that knows the body.

use std::f64::consts::TAU;

use host_sim::simulator::scenario::{Colour, Dipole, Scenario, Sensor, Simulation, Track};
use towmag_fourier::Complex;

use super::beside::Beside;

const RATE_HZ: f64 = 10.0;
/// Rows to either side among which a pass is the closest.
const ALONE: usize = 100;
/// From further away iron is neither seen nor in the way, m.
pub(crate) const FAR_M: f64 = 30.0;
/// Longest period of the simulator's rock over the shortest.
const SPAN: f64 = 20.0;

/// Where a dipole is passed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pass {
    pub(crate) row: usize,
    pub(crate) time_s: f64,
    pub(crate) distance_m: f64,
}

/// A dipole, and its passes, each with its signal to noise.
#[derive(Clone, Debug)]
pub(crate) struct Iron {
    pub(crate) dipole: Dipole,
    pub(crate) passes: Vec<(Pass, f64)>,
    /// Share of the signal to noise, over all passes, that is left beside the 18 terms.
    pub(crate) beside: f64,
}

impl Iron {
    /// Of the pass that tells most.
    pub(crate) fn snr(&self) -> f64 {
        self.passes.iter().map(|(_, snr)| *snr).fold(0.0, f64::max)
    }

    /// That of a survey that does not know the body.
    pub(crate) fn snr_beside(&self) -> f64 {
        self.snr() * self.beside
    }

    pub(crate) fn moment_am2(&self) -> f64 {
        length(self.dipole.moment_am2)
    }
}

/// Passes of a place, in order of time.
pub(crate) fn passes(track: &Track, place_m: &[f64; 3]) -> Vec<Pass> {
    let apart_m = |at: &[f64; 3]| length(std::array::from_fn(|i| at[i] - place_m[i]));
    let distance_m: Vec<f64> = track.place_m.iter().map(apart_m).collect();
    let last = distance_m.len() - 1;
    let is_pass = |&row: &usize| {
        let (first, end) = (row.saturating_sub(ALONE), (row + ALONE).min(last));
        let is_least =
            |other: usize| distance_m[row] < distance_m[other] || other >= row && distance_m[row] == distance_m[other];
        row > 0 && row < last && (first..=end).all(is_least)
    };
    let pass = |row: usize| {
        // Between rows: the square of the distance is a parabola in time.
        let square = |row: usize| distance_m[row] * distance_m[row];
        let (before, here, after) = (square(row - 1), square(row), square(row + 1));
        let bend = before - 2.0 * here + after;
        let shift = if bend > 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        let square_m2 = here - 0.25 * (before - after) * shift;
        Pass { row, time_s: (row as f64 + shift) / RATE_HZ, distance_m: square_m2.max(0.0).sqrt() }
    };
    (0..=last).filter(is_pass).map(pass).collect()
}

/// All iron of a tow.
pub(crate) fn iron(simulation: &Simulation, seed: u64) -> Vec<Iron> {
    let (track, scenario) = (simulation.track(), simulation.scenario());
    let body = Beside::new(simulation, seed);
    let of = |dipole: &Dipole| {
        let passes = passes(track, &dipole.place_m);
        let bounds = |k: usize| {
            let first = if k == 0 { 0 } else { (passes[k - 1].row + passes[k].row) / 2 };
            let end = passes.get(k + 1).map_or(track.place_m.len(), |next| (passes[k].row + next.row) / 2);
            first..end
        };
        let snr = |k: usize| snr(&anomaly_nt(simulation, dipole, bounds(k)), scenario);
        let near = (0..passes.len()).filter(|&k| passes[k].distance_m <= FAR_M);
        let [alone, left] = body.snr(&anomaly_nt(simulation, dipole, 0..track.place_m.len()));
        Iron { dipole: *dipole, passes: near.map(|k| (passes[k], snr(k))).collect(), beside: left / alone }
    };
    track.dipoles.iter().map(of).collect()
}

/// What a dipole adds to the size of the Earth's field.
fn anomaly_nt(simulation: &Simulation, dipole: &Dipole, rows: std::ops::Range<usize>) -> Vec<f64> {
    let track = simulation.track();
    let earth_nt = simulation.scenario().field.strength_nt.unwrap_or(50_000.0);
    rows.map(|row| {
        let iron_nt = dipole.field_nt(track.place_m[row]);
        length(std::array::from_fn(|i| earth_nt * track.earth[i] + iron_nt[i])) - earth_nt
    })
    .collect()
}

fn snr(anomaly_nt: &[f64], scenario: &Scenario) -> f64 {
    let rows = anomaly_nt.len();
    let mut transform: Vec<_> = anomaly_nt.iter().map(|&nt| Complex::new(nt, 0.0)).collect();
    towmag_fourier::forward(rows).process(&mut transform);
    let slowest_hz = least_hz(scenario);
    let square: f64 = (1..=rows / 2)
        .map(|k| (k, k as f64 * RATE_HZ / rows as f64))
        .filter(|(_, hz)| *hz >= slowest_hz)
        .map(|(k, hz)| {
            // Each frequency but the highest stands for its negative too.
            let twice = if 2 * k == rows { 1.0 } else { 2.0 };
            twice * transform[k].norm_sqr() / (rows as f64 * spectrum_nt2(scenario, hz))
        })
        .sum();
    square.sqrt()
}

/// Slowest of the rock; what is slower counts for nothing.
pub(crate) fn least_hz(scenario: &Scenario) -> f64 {
    1.0 / (SPAN * scenario.background.geology_shortest_period_s)
}

/// Variance of a row at a frequency, nT^2: white noise has that of its rows.
pub(crate) fn spectrum_nt2(scenario: &Scenario, hz: f64) -> f64 {
    let rock = &scenario.background;
    let fastest_hz = 1.0 / rock.geology_shortest_period_s;
    let density = rock.geology_rms_nt.powi(2) * fastest_hz / ((SPAN - 1.0) * hz * hz);
    let rock_nt2 = if hz <= fastest_hz { density * RATE_HZ / 2.0 } else { 0.0 };
    rock_nt2 + sensor_nt2(&scenario.scalar, hz) + scenario.scalar.resolution_nt.powi(2) / 12.0
}

fn sensor_nt2(sensor: &Sensor, hz: f64) -> f64 {
    let first_order = |correlation: f64| {
        let cos = (TAU * hz / RATE_HZ).cos();
        (1.0 - correlation * correlation) / (1.0 - 2.0 * correlation * cos + correlation * correlation)
    };
    let shape = match sensor.noise_colour {
        Colour::White => 1.0,
        Colour::Ar1 => first_order(sensor.noise_correlation),
        // As the simulator makes it: eleven first-order noises of equal power, from 0.003 Hz on an octave apart.
        Colour::Pink => {
            let corner = |part: i32| (-TAU * 0.003 * 2.0_f64.powi(part) / RATE_HZ).exp();
            (0..11).map(|part| first_order(corner(part))).sum::<f64>() / 11.0
        }
    };
    sensor.noise_rms_nt.powi(2) * shape
}

pub(crate) fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::draw::tow;
    use super::*;

    #[test]
    fn the_spectrum_is_that_of_what_is_made() {
        // Mean power of the made noise and rock in two bands, over sixteen seeds, against the formula.
        let mut scenario = tow(1).scenario;
        (scenario.dipoles, scenario.duration_s) = (Vec::new(), 1638.4);
        scenario.interference.uncompensated_std_nt = Some(0.0);
        scenario.background.diurnal_nt_per_h = 0.0;
        scenario.scalar.noise_rms_nt = 0.5;
        for colour in [Colour::White, Colour::Pink] {
            scenario.scalar.noise_colour = colour;
            let mut ratio = [0.0, 0.0];
            for seed in 0..16 {
                let simulation = Simulation::new(&scenario, seed).unwrap();
                let scalar_nt = simulation.record(&[]).readings.scalar_nt;
                let rows = scalar_nt.len();
                let mean_nt = scalar_nt.iter().sum::<f64>() / rows as f64;
                let window = |k: usize| (std::f64::consts::PI * k as f64 / rows as f64).sin().powi(2);
                let mut made: Vec<_> =
                    (0..rows).map(|k| Complex::new(window(k) * (scalar_nt[k] - mean_nt), 0.0)).collect();
                towmag_fourier::forward(rows).process(&mut made);
                for (band, ratio) in [[0.004, 0.014], [0.2, 3.0]].into_iter().zip(&mut ratio) {
                    let bin = |hz: f64| (hz * rows as f64 / RATE_HZ) as usize;
                    let bins = bin(band[0])..bin(band[1]);
                    // The window keeps 3/8 of the power.
                    let power: f64 = bins.clone().map(|k| made[k].norm_sqr() / (0.375 * rows as f64)).sum();
                    let formula: f64 = bins.map(|k| spectrum_nt2(&scenario, k as f64 * RATE_HZ / rows as f64)).sum();
                    *ratio += power / formula / 16.0;
                }
            }
            assert!((ratio[0] - 1.0).abs() < 0.2 && (ratio[1] - 1.0).abs() < 0.03, "{colour:?} {ratio:?}");
        }
    }

    #[test]
    fn a_matched_filter_meets_the_signal_to_noise() {
        // In white noise alone the signal to noise is the root of the energy over the noise.
        let mut scenario = tow(1).scenario;
        (scenario.background.geology_rms_nt, scenario.scalar.resolution_nt) = (0.0, 1e-6);
        scenario.scalar.noise_rms_nt = 0.02;
        scenario.scalar.noise_colour = Colour::White;
        let anomaly_nt: Vec<f64> =
            (0..6000).map(|k| ((k as f64 - 3000.0) * 0.1 / 2.0).powi(2)).map(|x| (-x).exp()).collect();
        let mean = anomaly_nt.iter().sum::<f64>() / 6000.0;
        let energy: f64 = anomaly_nt.iter().map(|nt| (nt - mean).powi(2)).sum();
        assert!((snr(&anomaly_nt, &scenario) / (energy.sqrt() / 0.02) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_straight_line_passes_once_where_the_dipole_is_abeam() {
        let place_m: Vec<[f64; 3]> = (0..2000).map(|k| [0.2 * f64::from(k), 0.0, 4.0]).collect();
        let mut track = Track::default();
        track.place_m = place_m;
        let found = passes(&track, &[100.05, 3.0, 8.0]);
        assert_eq!(found.len(), 1);
        assert!((found[0].time_s - 50.025).abs() < 1e-6 && (found[0].distance_m - 5.0).abs() < 1e-6, "{found:?}");
    }
}
