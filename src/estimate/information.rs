//! What a calibration hands on: the coefficients, and how well the data knew each combination of them.

use super::square_root_information::SquareRootInformation;
use crate::model::{Coefficients, TERMS};
use nalgebra::SMatrix;

/// Numbers in an upper triangle of 18 x 18.
pub const TRIANGLE: usize = TERMS * (TERMS + 1) / 2;

/// A calibration's information in 190 numbers: `R` with `R' R = sum x x'` over its band-passed rows, without any
/// penalty, the least-squares solution, and what that leaves of the scalar. The solution is not the elastic net's: the
/// penalty of eq. (7) pulls the barely determined combinations to zero, and whoever goes on learning from there must
/// first undo that (1.7 nT of residual instead of 1.2 on a real flight).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Information {
    centre: Coefficients,
    triangle: [f32; TRIANGLE],
    noise_nt: f32,
}

impl Information {
    /// From its parts: least-squares solution; rows of `R` from the diagonal on, in the core's basis, diagonal >= 0;
    /// root mean square of the residual, nT, above 0. `None` when a number is not finite or out of its range.
    pub fn new(centre: Coefficients, triangle: [f32; TRIANGLE], noise_nt: f32) -> Option<Self> {
        let finite = triangle.iter().all(|value| value.is_finite()) && noise_nt.is_finite() && noise_nt > 0.0;
        let positive = (0..TERMS).all(|i| triangle.get(start_of(i)).is_some_and(|&diagonal| diagonal >= 0.0));
        (finite && positive).then_some(Self { centre, triangle, noise_nt })
    }

    /// What a factor holds. `None` when its solution is not finite.
    pub(super) fn of(factor: &SquareRootInformation, noise_nt: f32) -> Option<Self> {
        let centre = Coefficients::from_basis(factor.least_squares())?;
        let (transposed, mut triangle) = (factor.transposed(), [0.0; TRIANGLE]);
        for i in 0..TERMS {
            let row = transposed.column(i).into_owned();
            triangle[start_of(i)..start_of(i + 1)].copy_from_slice(&row.as_slice()[i..]);
        }
        Self::new(centre, triangle, noise_nt)
    }

    /// The least-squares solution.
    pub fn centre(&self) -> &Coefficients {
        &self.centre
    }

    /// Rows of `R` from the diagonal on.
    pub fn triangle(&self) -> &[f32; TRIANGLE] {
        &self.triangle
    }

    /// Root mean square of what the solution leaves of the band-passed scalar, nT.
    pub fn noise_nt(&self) -> f32 {
        self.noise_nt
    }

    /// A factor that holds `share` (0 to 1) of this information, centred on the solution.
    pub(super) fn factor(&self, share: f32) -> SquareRootInformation {
        let root = libm::sqrtf(share);
        let transposed = SMatrix::from_fn(|j, i| if j < i { 0.0 } else { root * self.triangle[start_of(i) + j - i] });
        SquareRootInformation::centred(&transposed, &self.centre)
    }
}

/// Place of the diagonal of a row in the triangle.
const fn start_of(row: usize) -> usize {
    // A row is one shorter than the one before it.
    row * (2 * TERMS + 1 - row) / 2
}

/// Where an estimator starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Coefficients of the calibration; [`Coefficients::ZERO`] without one.
    pub coefficients: Coefficients,
    /// How well the calibration knew them, if that was kept.
    pub information: Option<Information>,
    /// What the calibration has learnt of the level, if that was kept: in columns and units of its own, see
    /// [`LevelEstimator`](super::LevelEstimator).
    pub level: Option<Information>,
}

impl From<Coefficients> for Prior {
    /// Coefficients of which nothing more is known.
    fn from(coefficients: Coefficients) -> Self {
        Self { coefficients, information: None, level: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Row, TermVector};

    #[test]
    fn what_is_packed_comes_back() {
        let mut factor = SquareRootInformation::EMPTY;
        for k in 0..60_u32 {
            let terms =
                TermVector::from_fn(|i, _| ((k * 31 + i as u32 * 17 + k * k * i as u32) % 23) as f32 / 7.0 - 1.5);
            factor.add(&Row { terms, scalar_nt: (k % 11) as f32 - 4.0 });
        }
        let information = Information::of(&factor, 0.5).unwrap();
        let again = Information::of(&information.factor(1.0), 0.5).unwrap();
        assert_eq!(again, information);
        let residual = factor.residual_vector(information.centre());
        assert!(residual.iter().all(|rest| rest.abs() < 1e-3), "{residual:?}");
    }

    #[test]
    fn what_is_no_information_is_refused() {
        let mut triangle = [1.0; TRIANGLE];
        assert!(Information::new(Coefficients::ZERO, triangle, 0.0).is_none());
        assert!(Information::new(Coefficients::ZERO, triangle, f32::NAN).is_none());
        triangle[start_of(3)] = -1.0;
        assert!(Information::new(Coefficients::ZERO, triangle, 1.0).is_none());
        triangle[start_of(3)] = f32::INFINITY;
        assert!(Information::new(Coefficients::ZERO, triangle, 1.0).is_none());
    }
}
