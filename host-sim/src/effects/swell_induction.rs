//! `swell_induction`: moving sea water makes a field of its own. `s' = s + g H(z)`, `H` the Hilbert transform of the
//! depth in 0.05 to 0.5 Hz, a quarter period behind.

use towmag_fourier::Complex;

use super::parts::{depth_m, linear};
use crate::effects::{Change, Column, Draw, Driver, Effect, Parameter, Spec};
use crate::recording::RATE_HZ;
use crate::simulator::signals::Signals;

/// The effect `swell_induction`.
#[derive(Debug)]
pub struct SwellInduction;

/// Where swell is.
const BAND_HZ: std::ops::RangeInclusive<f64> = 0.05..=0.5;
/// What is mirrored at each end, s: two of the longest periods, so that the ends do not ring.
const MARGIN_S: f64 = 40.0;

const PARAMETERS: &[Parameter] = &[linear("gain_nT_per_m", "nT/m", 1000.0, 5.0)];

const SPEC: Spec = Spec {
    name: "swell_induction",
    title: "a field induced by the swell",
    what: "a field that goes with the swell, a quarter period behind the heave",
    origin: "sea water moved through the Earth's field by swell carries currents",
    source: "1.7 nT per metre of amplitude at 13 s (Weaver 1965; Lilley 2004); none in fresh water",
    model: "`s' = s + g H(z)`: the depth in 0.05 to 0.5 Hz, a quarter period behind; needs a tow",
    parameters: PARAMETERS,
    needs: Some(Column::Depth),
    driver: Some(Driver::Swell),
    band_edges_hz: &[0.05, 0.5],
    ..Spec::BASE
};

impl Effect for SwellInduction {
    fn spec(&self) -> &'static Spec {
        &SPEC
    }

    fn change(&self, signals: &Signals, parameters: &[f64], _: &mut Draw) -> Change {
        let depth_m = depth_m(signals);
        let quadrature = signals.segments().iter().flat_map(|segment| quadrature(&depth_m[segment.epochs.clone()]));
        Change::of_scalar(quadrature.map(|m| parameters[0] * m).collect())
    }
}

/// The depth in the band of swell, a quarter period behind; rows without gaps.
pub(crate) fn quadrature(depth_m: &[f64]) -> Vec<f64> {
    let count = depth_m.len();
    let margin = ((MARGIN_S * RATE_HZ) as usize).min(count - 1);
    let mut spectrum = mirrored(depth_m, margin);
    let length = spectrum.len();
    // The scalar algorithms: those of vector units round differently from machine to machine.
    towmag_fourier::scalar::forward(length).process(&mut spectrum);
    for (k, value) in spectrum.iter_mut().enumerate() {
        let frequency_hz = k.min(length - k) as f64 * RATE_HZ / length as f64;
        let behind = if 2 * k < length { Complex::new(0.0, -1.0) } else { Complex::new(0.0, 1.0) };
        *value = if BAND_HZ.contains(&frequency_hz) { *value * behind / length as f64 } else { Complex::ZERO };
    }
    towmag_fourier::scalar::inverse(length).process(&mut spectrum);
    spectrum[margin..margin + count].iter().map(|value| value.re).collect()
}

/// Odd mirror images at both ends: value and slope go on.
fn mirrored(depth_m: &[f64], margin: usize) -> Vec<Complex<f64>> {
    let (first, last, end) = (depth_m[0], depth_m[depth_m.len() - 1], depth_m.len() - 1);
    let before = (1..=margin).rev().map(|k| 2.0 * first - depth_m[k]);
    let after = (1..=margin).map(|k| 2.0 * last - depth_m[end - k]);
    // A length of small factors, or the transform of a prime takes ten times as long.
    let used = depth_m.len() + 2 * margin;
    let longer = (used.next_multiple_of(256)) - used;
    let whole = before.chain(depth_m.iter().copied()).chain(after);
    let mean_m = depth_m.iter().sum::<f64>() / depth_m.len() as f64;
    whole.map(|m| Complex::new(m - mean_m, 0.0)).chain(std::iter::repeat_n(Complex::ZERO, longer)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::no_draw;
    use crate::simulator::signals::tests::{signals_of, trajectory};
    use std::f64::consts::TAU;

    #[test]
    fn a_sine_of_swell_comes_a_quarter_period_behind_and_a_tide_not_at_all() {
        for period_s in [4.0, 10.0] {
            let mut trajectory = trajectory();
            let depth = |t: &f64| 12.0 + 0.002 * t + 1.5 * (TAU * t / period_s).sin();
            trajectory.depth_m = Some(trajectory.epochs_s.iter().map(depth).collect());
            let signals = signals_of(trajectory);
            let change = SwellInduction.change(&signals, &[2.0], &mut no_draw());
            for (time_s, nt) in signals.epochs_s().iter().zip(change.scalar_nt).skip(100).take(400) {
                let expected_nt = 2.0 * 1.5 * (TAU * (time_s - period_s / 4.0) / period_s).sin();
                assert!((nt - expected_nt).abs() < 0.15, "{period_s} {time_s}: {nt} {expected_nt}");
            }
        }
    }
}
