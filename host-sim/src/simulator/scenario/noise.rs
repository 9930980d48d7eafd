//! Noise of a colour, one value a row.

use std::f64::consts::TAU;

use rand_distr::{Distribution, StandardNormal};

use super::{Colour, Sensor};
use crate::effects::Draw;
use crate::recording::RATE_HZ;

/// Corner frequencies of the first-order noises whose sum is pink, Hz: three an octave apart in every decade.
const LOWEST_HZ: f64 = 0.003;
const PINK_PARTS: usize = 11;

/// `rows` values of a sensor's noise, nT.
pub(super) fn noise_nt(sensor: &Sensor, rows: usize, draw: &mut Draw) -> Vec<f64> {
    match sensor.noise_colour {
        Colour::White => first_order(0.0, sensor.noise_rms_nt, rows, draw),
        Colour::Ar1 => first_order(sensor.noise_correlation, sensor.noise_rms_nt, rows, draw),
        Colour::Pink => pink(sensor.noise_rms_nt, rows, draw),
    }
}

/// AR(1) that starts in its stationary state.
fn first_order(correlation: f64, rms_nt: f64, rows: usize, draw: &mut Draw) -> Vec<f64> {
    let mut gauss = || -> f64 { StandardNormal.sample(draw) };
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut value = gauss();
    let mut out = Vec::with_capacity(rows);
    for _ in 0..rows {
        out.push(rms_nt * value);
        value = correlation * value + fresh * gauss();
    }
    out
}

/// The sum of first-order noises of equal power, their corners an octave apart, is pink between the outer corners.
fn pink(rms_nt: f64, rows: usize, draw: &mut Draw) -> Vec<f64> {
    let part_rms_nt = rms_nt / (PINK_PARTS as f64).sqrt();
    let mut sum = vec![0.0; rows];
    for part in 0..PINK_PARTS {
        let corner_hz = LOWEST_HZ * f64::from(1_u32 << part);
        let correlation = libm::exp(-TAU * corner_hz / RATE_HZ);
        let one = first_order(correlation, part_rms_nt, rows, draw);
        sum.iter_mut().zip(one).for_each(|(sum, value)| *sum += value);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn made(colour: Colour, correlation: f64) -> Vec<f64> {
        let sensor = Sensor {
            noise_rms_nt: 2.0,
            noise_colour: colour,
            noise_correlation: correlation,
            resolution_nt: 0.001,
            decimals: None,
        };
        noise_nt(&sensor, 200_000, &mut Draw::seed_from_u64(3))
    }

    fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
        (values.clone().map(|x| x * x).sum::<f64>() / values.count() as f64).sqrt()
    }

    #[test]
    fn the_rms_is_as_asked_and_the_correlation_too() {
        for (colour, correlation) in [(Colour::White, 0.0), (Colour::Ar1, 0.9), (Colour::Pink, 0.0)] {
            let values = made(colour, correlation);
            assert!((rms(values.iter().copied()) / 2.0 - 1.0).abs() < 0.05, "{colour:?}");
            let neighbours: f64 = values.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / 200_000.0 / 4.0;
            assert!(colour == Colour::Pink || (neighbours - correlation).abs() < 0.02, "{colour:?} {neighbours}");
        }
    }

    #[test]
    fn pink_noise_has_the_same_power_in_every_octave() {
        let values = made(Colour::Pink, 0.0);
        // Differences of means over blocks of length n see about the octave around 10 / 2n Hz.
        let octave = |n: usize| {
            let means: Vec<f64> = values.chunks_exact(n).map(|chunk| chunk.iter().sum::<f64>() / n as f64).collect();
            rms(means.windows(2).map(|pair| pair[1] - pair[0]))
        };
        let of = [8, 16, 32, 64, 128].map(octave);
        assert!(of.windows(2).all(|pair| (0.9..1.1).contains(&(pair[1] / pair[0]))), "{of:?}");
    }
}
