//! The periodogram of a whole residual.

use towmag_fourier::Complex;

/// Periodogram from 0 Hz to below half of the rate: exponential of mean 1 for white noise of variance 1.
pub(super) fn powers(z: &[f64]) -> Vec<f64> {
    let n = z.len();
    let mut spectrum: Vec<Complex<f64>> = z.iter().map(|z| Complex::new(*z, 0.0)).collect();
    towmag_fourier::forward(n).process(&mut spectrum);
    spectrum[..n / 2].iter().map(|value| value.norm_sqr() / n as f64).collect()
}
