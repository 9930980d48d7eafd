//! The anomaly of the total field that a dipole makes on a straight pass.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

/// `mu0 / (4 pi)` in nT m^3 / (A m^2).
pub(super) const NT_M3_PER_AM2: f64 = 100.0;

/// What total-field anomalies of dipoles of any direction are sums of, `u` being the way from the nearest point over the
/// distance: `u^k / (1 + u^2)^(5/2)` (Anderson functions: Anderson, Magnetic airborne detection frequency responses, 1949).
pub fn profiles(u: f64) -> [f64; 3] {
    let square = 1.0 + u * u;
    let first = 1.0 / (square * square * square.sqrt());
    [first, u * first, u * u * first]
}

/// A dipole that was passed: `at` and `distance` in the unit of the way, metres or seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dipole {
    /// The way at the closest approach.
    pub at: f64,
    /// Closest distance.
    pub distance: f64,
    /// Where it is about the track there, from straight down toward starboard: of effect only where the way bends.
    pub side_rad: f64,
    /// Amplitudes of the three profiles, nT.
    pub amplitudes_nt: [f64; 3],
}

/// The sum of profiles of these amplitudes, nT.
pub(super) fn weighed(profiles: [f64; 3], amplitudes_nt: [f64; 3]) -> f64 {
    profiles.iter().zip(amplitudes_nt).map(|(profile, nt)| profile * nt).sum()
}

/// Amplitudes of the three profiles, nT, a moment in units of `distance^3 / 100` A m^2, in axes (forward, starboard, down);
/// `toward` is the unit vector from the sensor at its closest to the object (no forward part), `field` that of the Earth's field.
///
/// The dipole law `100 nT (3 (m . r) r / r^5 - m / r^3) . field`, with `r = distance (u forward - toward)`, sorted by powers of `u`.
pub(super) fn amplitudes_of_moment(toward: Vector3<f64>, field: Vector3<f64>) -> Matrix3<f64> {
    let forward = Vector3::x();
    let (fx, fp) = (field.dot(&forward), field.dot(&toward));
    Matrix3::from_rows(&[
        (3.0 * fp * toward - field).transpose(),
        (-3.0 * (fp * forward + fx * toward)).transpose(),
        (3.0 * fx * forward - field).transpose(),
    ])
}

/// So many directions, evenly over a sphere (a Fibonacci lattice).
pub(super) fn directions(count: usize) -> impl Iterator<Item = Vector3<f64>> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        Vector3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    })
}
