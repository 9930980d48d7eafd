//! The residual as a pulse train of constant moment in the body would leave it.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use towmag_fourier::Complex;

use crate::diagnosis::policy::RATE_HZ;
use crate::diagnosis::regression::problem::{Fit, RegressionProblem};
use crate::diagnosis::regression::projection::explained;

/// Harmonics that are summed up for the power of a pulse train, at most.
const MOST_HARMONICS: usize = 200;

/// Frequencies at which the share that the background leaves is told: how many, and their step, Hz.
const BACKGROUND_STEPS: usize = 100;
const BACKGROUND_STEP_HZ: f64 = 0.005;
/// Blocks that stand for all of them there.
const BACKGROUND_BLOCKS: usize = 4;
/// Least share of its power that counts as left of a harmonic.
const LEAST_LEFT: f64 = 0.02;

/// The residual, one a row, times each cosine of the direction.
pub(super) struct DirectedResidual<'a> {
    problem: &'a RegressionProblem<'a>,
    /// The whitened residual taken back to the rows by the transpose of the whitening, so that its product with a raw
    /// column is that of the whitened ones.
    pub(super) rows: Vec<[f64; 3]>,
    /// Inverse of the mean products of the cosines.
    inverse: Matrix3<f64>,
    samples: f64,
    /// Share of the power of a sine that the background leaves, at steps of [`BACKGROUND_STEP_HZ`].
    left: Vec<f64>,
}

impl<'a> DirectedResidual<'a> {
    pub(super) fn of(problem: &'a RegressionProblem<'a>, fit: &Fit) -> Self {
        let adjoint = problem.whitening.transposed(&fit.residual_whitened, problem.signals.len());
        let direction = &problem.signals.rows().direction;
        let rows = adjoint.iter().zip(direction).map(|(adjoint, c)| c.map(|cosine| cosine * adjoint)).collect();
        let samples = problem.whitening.samples() as f64;
        let mean = |i: usize, j: usize| {
            problem.whitening.rows().map(|row| direction[row][i] * direction[row][j]).sum::<f64>() / samples
        };
        Self { problem, rows, inverse: pseudo_inverse(&DMatrix::from_fn(3, 3, mean)), samples, left: left(problem) }
    }

    pub(super) fn epochs_s(&self) -> &[f64] {
        self.problem.signals.epochs_s()
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.problem.duration_s()
    }

    /// What a moment in the body explains by its products `q` with the residual, before it is divided by its power.
    pub(super) fn explained(&self, q: Vector3<f64>) -> f64 {
        q.dot(&(self.inverse * q))
    }

    /// Power over all samples, whitened, of a sine of a frequency with a mean square of 1.
    pub(super) fn power_of_sine(&self, hz: f64) -> f64 {
        self.samples * self.response(hz)
    }

    /// Power of a unit pulse train over all samples, whitened: by its harmonics.
    pub(super) fn power_of_pulses(&self, period_s: f64, duty: f64) -> f64 {
        let mut power = 0.0;
        let last = ((0.5 * RATE_HZ * period_s) as usize).min(MOST_HARMONICS);
        for h in 1..=last {
            let amplitude = 2.0 * (std::f64::consts::PI * h as f64 * duty).sin() / (std::f64::consts::PI * h as f64);
            let hz = h as f64 / period_s;
            let left = self.left.get((hz / BACKGROUND_STEP_HZ).round() as usize).copied().unwrap_or(1.0);
            power += 0.5 * amplitude * amplitude * left * self.response(hz);
        }
        (power * self.samples).max(f64::MIN_POSITIVE)
    }

    fn response(&self, hz: f64) -> f64 {
        self.problem.whitening.predictor().response(hz / RATE_HZ)
    }
}

/// What is left of a sine of each frequency, as a share of its power, beside what is projected out of a block.
fn left(problem: &RegressionProblem<'_>) -> Vec<f64> {
    let blocks = problem.whitening.blocks().len();
    let step = blocks.div_ceil(BACKGROUND_BLOCKS).max(1);
    let directions: Vec<&[f64]> =
        (0..blocks).step_by(step).flat_map(|block| problem.whitening.directions(block)).collect();
    let samples: usize = problem.whitening.blocks().iter().step_by(step).map(|block| block.len()).sum();
    let at = |k: usize| {
        let turn = Complex::cis(std::f64::consts::TAU * k as f64 * BACKGROUND_STEP_HZ / RATE_HZ);
        // Horner's scheme, as a polynomial in the turn of one row.
        let product = |direction: &&[f64]| direction.iter().fold(Complex::ZERO, |sum: Complex<f64>, x| sum * turn + x);
        let taken: f64 = directions.iter().map(|direction| product(direction).norm_sqr()).sum();
        (1.0 - 2.0 * taken / samples as f64).max(LEAST_LEFT)
    };
    (0..BACKGROUND_STEPS).map(at).collect()
}

/// Inverse of a symmetric matrix, 0 along directions that it does not have.
fn pseudo_inverse(matrix: &DMatrix<f64>) -> Matrix3<f64> {
    let unit = |k: usize| DVector::from_fn(3, |i, _| f64::from(u8::from(i == k)));
    Matrix3::from_columns(&[0, 1, 2].map(|k| Vector3::from_column_slice(explained(matrix, &unit(k)).1.as_slice())))
}
