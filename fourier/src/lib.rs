//! The fast Fourier transform of `rustfft`, for `f64`.
//!
//! `rustfft` is generic: every crate that calls it compiles its whole set of butterflies again, for each vector unit, and
//! again with its tests. Nothing here is generic, nor inlined where it is called, so that this happens once.
#![cfg_attr(target_os = "none", no_std)]
#![cfg(not(target_os = "none"))]
#![forbid(unsafe_code)]

use std::sync::Arc;

pub use rustfft::num_complex::{Complex, Complex64};
use rustfft::{FftDirection, FftPlanner, FftPlannerScalar};

/// How to transform values of one length in one direction, unnormalised: forward and back multiplies by the length.
pub type Plan = Arc<dyn rustfft::Fft<f64>>;

/// Plans transforms by the fastest vector unit of this machine, and keeps those of lengths that it has met.
pub struct Planner(FftPlanner<f64>);

impl Default for Planner {
    fn default() -> Self {
        Self::new()
    }
}

impl Planner {
    /// Without a plan as yet.
    #[inline(never)]
    pub fn new() -> Self {
        Self(FftPlanner::new())
    }

    /// `sum x[n] exp(-2 pi i k n / length)`.
    #[inline(never)]
    pub fn forward(&mut self, length: usize) -> Plan {
        self.0.plan_fft_forward(length)
    }

    /// `sum x[k] exp(2 pi i k n / length)`.
    #[inline(never)]
    pub fn inverse(&mut self, length: usize) -> Plan {
        self.0.plan_fft_inverse(length)
    }
}

/// One transform forward, by the fastest vector unit.
pub fn forward(length: usize) -> Plan {
    Planner::new().forward(length)
}

/// One transform back, by the fastest vector unit.
pub fn inverse(length: usize) -> Plan {
    Planner::new().inverse(length)
}

/// Transforms by the scalar algorithms, for what must have the same bits on every machine: vector units round differently.
pub mod scalar {
    use super::{FftDirection, FftPlannerScalar, Plan};

    /// As [`forward`](super::forward).
    #[inline(never)]
    pub fn forward(length: usize) -> Plan {
        FftPlannerScalar::new().plan_fft(length, FftDirection::Forward)
    }

    /// As [`inverse`](super::inverse).
    #[inline(never)]
    pub fn inverse(length: usize) -> Plan {
        FftPlannerScalar::new().plan_fft(length, FftDirection::Inverse)
    }
}
