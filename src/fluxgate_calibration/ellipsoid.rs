//! The ellipsoid on which the readings of a turned sensor lie: least squares from their moments.
//!
//! `|W (v - c)| = F` for readings `v`, their centre `c` and the field `F`; of `W` only `G = W' W` shows. The residual of an
//! epoch is
//!
//! ```text
//! ((v - c)' G (v - c) - F^2) / 2F  =  r + r^2 / 2F,  r = |W (v - c)| - F
//! ```
//!
//! which is the distance itself but for 3e-6 nT at 0.5 nT of noise and 50,000 nT. It is linear in the products and
//! components of `v`, so that 11 x 11 moments hold every epoch, and Gauss-Newton over the nine unknowns is a linear least
//! squares about the centre of the step before.
//!
//! `f64`: the moments square the condition number, and what noise of 0.5 nT adds is a 10^-10th of them. Summed in `f32`,
//! they leave up to 7 nT of error on the tumblings of `virtual-body/tests/fluxgate_calibration`, instead of 0.6 nT.

use crate::policy::{PRIOR_CENTRE_NT, PRIOR_SHAPE, TURNING_ERROR_NT};
use nalgebra::{Cholesky, Const, Matrix3, SMatrix, SVector, Vector3};

/// Unknowns: six entries of `G`, three of the centre.
pub(super) const UNKNOWNS: usize = 9;

/// The entries of `G` in their order.
pub(super) const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Place of the first component of the centre among the unknowns, and of the first component of `v` among the columns.
pub(super) const LINEAR: usize = ENTRIES.len();

/// Column of the constant.
const ONE: usize = UNKNOWNS;

/// Column of the square of the field.
const FIELD: usize = ONE + 1;

/// Columns of an epoch: `v v'`, `-2 v`, 1 and `F^2`.
const COLUMNS: usize = FIELD + 1;

/// Columns about a centre: the unknowns, and the square of the field.
const CENTRED: usize = UNKNOWNS + 1;

type Unknowns = SVector<f64, UNKNOWNS>;
type Centred = SMatrix<f64, CENTRED, CENTRED>;
type Factor = Cholesky<f64, Const<UNKNOWNS>>;

/// Gauss-Newton steps at most. From 2,000 nT away it takes three.
const MOST_STEPS: usize = 12;

/// A last step of the centre, nT: far below any noise.
const LAST_STEP_NT: f64 = 1e-3;

/// Moments of all epochs so far.
#[derive(Clone, Debug)]
pub(super) struct Ellipsoid {
    moments: SMatrix<f64, COLUMNS, COLUMNS>,
    /// Field of the first epoch, nT: the unit of what the moments are of. 0 before it.
    unit_nt: f64,
}

/// The best ellipsoid.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    /// `G`.
    pub(super) shape: Matrix3<f64>,
    /// `c`, nT.
    pub(super) centre_nt: Vector3<f64>,
    /// Covariance of the entries of `G` and of `G` times the centre in `unit_nt`, for independent residuals of one nT.
    pub(super) covariance: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    /// Unit of the centre in the covariance, nT: the field.
    pub(super) unit_nt: f64,
    /// Sum of the squares of the residuals, nT^2.
    pub(super) squares: f64,
}

impl Ellipsoid {
    /// No epoch.
    pub(super) fn new() -> Self {
        Self { moments: SMatrix::zeros(), unit_nt: 0.0 }
    }

    /// Take in a reading and the field at the same instant, nT, above zero.
    pub(super) fn add(&mut self, reading_nt: &Vector3<f64>, field_nt: f64) {
        if self.unit_nt == 0.0 {
            self.unit_nt = field_nt;
        }
        let [x, y, z] = (reading_nt / self.unit_nt).into();
        let field = field_nt / self.unit_nt;
        let products = [x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z];
        let rest = [-2.0 * x, -2.0 * y, -2.0 * z, 1.0, field * field];
        let columns = products.into_iter().chain(rest);
        let row = SVector::<f64, COLUMNS>::from_iterator(columns) * (self.unit_nt / (2.0 * field));
        self.moments.ger(1.0, &row, &row, 1.0);
    }

    /// The ellipsoid that leaves the least squares, where nothing is known held by the prior; `None` when none is found.
    pub(super) fn fit(&self) -> Option<Fit> {
        let mut centre = Vector3::zeros();
        for _ in 0..MOST_STEPS {
            let moments = self.about(&centre);
            let (cholesky, unknowns) = self.solution(&moments)?;
            let shape = shape(&unknowns);
            let step = shape.try_inverse()? * unknowns.fixed_rows::<3>(LINEAR);
            centre += step;
            if step.norm() * self.unit_nt < LAST_STEP_NT {
                let residual = unknowns.push(-1.0);
                let squares = residual.dot(&(moments * residual)).max(0.0);
                return Some(Fit { squares, ..self.solved(shape, &centre, &cholesky) });
            }
        }
        None
    }

    /// How well each unknown would be known, were the readings on a sphere about zero. It tells what was not turned through
    /// where there are too few directions for a fit.
    pub(super) fn sphere(&self) -> Option<Fit> {
        let (cholesky, _) = self.solution(&self.about(&Vector3::zeros()))?;
        let squares: f64 = (0..3).map(|axis| self.moments[(axis, ONE)]).sum();
        let shape = Matrix3::identity() * (self.moments[(FIELD, ONE)] / squares);
        Some(self.solved(shape, &Vector3::zeros(), &cholesky))
    }

    fn solution(&self, moments: &Centred) -> Option<(Factor, Unknowns)> {
        let (weights, expected) = self.prior();
        let normal = moments.fixed_view::<UNKNOWNS, UNKNOWNS>(0, 0) + SMatrix::from_diagonal(&weights);
        let target = moments.fixed_view::<UNKNOWNS, 1>(0, UNKNOWNS) + weights.component_mul(&expected);
        let cholesky = normal.cholesky()?;
        let unknowns = cholesky.solve(&target);
        Some((cholesky, unknowns))
    }

    fn solved(&self, shape: Matrix3<f64>, centre: &Vector3<f64>, cholesky: &Factor) -> Fit {
        let (centre_nt, covariance) = (centre * self.unit_nt, cholesky.inverse());
        Fit { shape, centre_nt, covariance, unit_nt: self.unit_nt, squares: 0.0 }
    }

    /// Information of the prior about each unknown, and what it expects: the present settings.
    fn prior(&self) -> (Unknowns, Unknowns) {
        let information = |std: f64| (TURNING_ERROR_NT / std) * (TURNING_ERROR_NT / std);
        let [of_shape, of_centre] = [PRIOR_SHAPE, PRIOR_CENTRE_NT / self.unit_nt].map(information);
        let weights = SVector::from_fn(|i, _| if i < LINEAR { of_shape } else { of_centre });
        (weights, SVector::from_fn(|i, _| if i < 3 { 1.0 } else { 0.0 }))
    }

    /// The moments of `z z'`, `-2 z` and `F^2`, with `z` the readings less `centre`; what is left of the constant is of the
    /// second order in the step.
    fn about(&self, centre: &Vector3<f64>) -> Centred {
        let mut columns = SMatrix::<f64, COLUMNS, CENTRED>::zeros();
        for (place, (i, j)) in ENTRIES.into_iter().enumerate() {
            let pairs = if i == j { 1.0 } else { 2.0 };
            columns[(place, place)] = 1.0;
            columns[(LINEAR + i, place)] = centre[j];
            columns[(LINEAR + j, place)] = centre[i];
            columns[(ONE, place)] = pairs * centre[i] * centre[j];
        }
        for i in 0..3 {
            columns[(LINEAR + i, LINEAR + i)] = 1.0;
            columns[(ONE, LINEAR + i)] = 2.0 * centre[i];
        }
        columns[(FIELD, UNKNOWNS)] = 1.0;
        columns.tr_mul(&(self.moments * columns))
    }
}

/// The matrix of the entries that the unknowns begin with.
fn shape(unknowns: &Unknowns) -> Matrix3<f64> {
    let mut shape = Matrix3::zeros();
    for ((i, j), entry) in ENTRIES.into_iter().zip(unknowns) {
        shape[(i, j)] = *entry;
        shape[(j, i)] = *entry;
    }
    shape
}
