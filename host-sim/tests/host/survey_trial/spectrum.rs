//! The true spectrum of a tow, and what is whitened by it.

use std::f64::consts::TAU;

use host_sim::simulator::scenario::{Colour, Scenario, Sensor};
use nalgebra::DVector;
use towmag_fourier::Complex;

use super::zero_phase::RATE_HZ;

/// Longest period of the simulator's rock over the shortest.
const SPAN: f64 = 20.0;

/// Real and imaginary parts of the transform of all rows, each of variance one for noise of the true spectrum; without what is
/// slower than the slowest rock. Its length is the signal to noise of the matched filter.
pub(crate) fn whitened(values: &[f64], scenario: &Scenario) -> DVector<f64> {
    let rows = values.len();
    let mut transform: Vec<_> = values.iter().map(|&nt| Complex::new(nt, 0.0)).collect();
    towmag_fourier::forward(rows).process(&mut transform);
    let slowest_hz = 1.0 / (SPAN * scenario.background.geology_shortest_period_s);
    let parts = (1..=rows / 2).map(|k| (k, k as f64 * RATE_HZ / rows as f64)).filter(|(_, hz)| *hz >= slowest_hz);
    let parts = parts.flat_map(|(k, hz)| {
        // Each frequency but the highest stands for its negative too.
        let twice = if 2 * k == rows { 1.0 } else { 2.0 };
        let scale = (twice / (rows as f64 * spectrum_nt2(scenario, hz))).sqrt();
        [scale * transform[k].re, scale * transform[k].im]
    });
    DVector::from_vec(parts.collect())
}

/// Variance of a row at a frequency, nT^2: white noise has that of its rows.
fn spectrum_nt2(scenario: &Scenario, hz: f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use host_sim::simulator::scenario::Simulation;

    use super::super::draw::tow;
    use super::*;

    #[test]
    fn the_spectrum_is_that_of_what_is_made() {
        // Mean power of the made noise and rock in two bands, over eight seeds, against the formula.
        let mut scenario = tow(1).scenario;
        (scenario.dipoles, scenario.duration_s) = (Vec::new(), 1638.4);
        scenario.interference.uncompensated_std_nt = Some(0.0);
        scenario.background.diurnal_nt_per_h = 0.0;
        scenario.scalar.noise_rms_nt = 0.5;
        for colour in [Colour::White, Colour::Pink] {
            scenario.scalar.noise_colour = colour;
            let mut ratio = [0.0, 0.0];
            for seed in 0..8 {
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
                    *ratio += power / formula / 8.0;
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
        assert!((whitened(&anomaly_nt, &scenario).norm() / (energy.sqrt() / 0.02) - 1.0).abs() < 1e-6);
    }
}
