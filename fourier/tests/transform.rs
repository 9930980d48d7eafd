//! Against the sum that defines a transform.
#![cfg(not(target_os = "none"))]

use std::f64::consts::TAU;

use towmag_fourier::{Complex, Complex64, forward, inverse, scalar};

#[test]
fn a_transform_is_the_sum_that_defines_it_and_its_inverse_gives_the_values_back() {
    let values: Vec<Complex64> = (0..30).map(|n| Complex::new(f64::from(n * n % 7), f64::from(n % 3))).collect();
    let sum = |k: usize| -> Complex64 {
        values.iter().enumerate().map(|(n, x)| x * Complex::cis(-TAU * (k * n) as f64 / 30.0)).sum()
    };
    for [there, back] in [[forward(30), inverse(30)], [scalar::forward(30), scalar::inverse(30)]] {
        let mut spectrum = values.clone();
        there.process(&mut spectrum);
        assert!(spectrum.iter().enumerate().all(|(k, x)| (x - sum(k)).norm() < 1e-12));
        back.process(&mut spectrum);
        assert!(spectrum.iter().zip(&values).all(|(x, value)| (x / 30.0 - value).norm() < 1e-14));
    }
}
