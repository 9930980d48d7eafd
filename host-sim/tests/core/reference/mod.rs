//! The whole chain in f64, straight from the equations: what the f32 core is held to. Shares no code with it.
#![allow(dead_code, unreachable_pub)] // each test binary uses its part of it

pub mod adaptive;

use nalgebra::{SMatrix, SVector};
use towmag::Epoch;

pub type Vector = SVector<f64, 18>;
pub type Matrix = SMatrix<f64, 18, 18>;

/// Columns of eq. (4) in its own units: permanent without unit, induced in nT, eddy in nT/s.
pub fn columns(flux_nt: [f64; 3], before_nt: [f64; 3]) -> Vector {
    let (flux, before) = (nalgebra::Vector3::from(flux_nt), nalgebra::Vector3::from(before_nt));
    let (magnitude, u) = (flux.norm(), flux.normalize());
    let rate = (u - before.normalize()) / 0.1;
    let mut columns = Vector::zeros();
    let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    for i in 0..3 {
        columns[i] = u[i];
        for j in 0..3 {
            columns[9 + 3 * i + j] = magnitude * u[i] * rate[j];
        }
    }
    for (k, (i, j)) in pairs.into_iter().enumerate() {
        columns[3 + k] = magnitude * u[i] * u[j];
    }
    columns
}

/// `scipy.signal.butter(4, [0.1, 0.9], btype="band", fs=10, output="sos")`, scipy 1.17.
const SOS: [[f64; 6]; 4] = [
    [0.002234891698082327, 0.004469783396164654, 0.002234891698082327, 1.0, -1.2850126432444133, 0.4387649162553223],
    [1.0, 2.0, 1.0, 1.0, -1.4603171736403668, 0.716955991560341],
    [1.0, -2.0, 1.0, 1.0, -1.8696631749453867, 0.8751934078136212],
    [1.0, -2.0, 1.0, 1.0, -1.9565142836160259, 0.9605568000834551],
];

/// Direct form II transposed, started in the steady state of its first input.
#[derive(Clone)]
struct BandPass {
    memory: [[f64; 2]; 4],
}

impl BandPass {
    fn steady(first: f64) -> Self {
        let mut memory = [[0.0; 2]; 4];
        let mut x = first;
        for ([b0, b1, b2, _, a1, a2], memory) in SOS.into_iter().zip(&mut memory) {
            let y = x * (b0 + b1 + b2) / (1.0 + a1 + a2);
            *memory = [y - b0 * x, b2 * x - a2 * y];
            x = y;
        }
        Self { memory }
    }

    fn step(&mut self, mut x: f64) -> f64 {
        for ([b0, b1, b2, _, a1, a2], memory) in SOS.into_iter().zip(&mut self.memory) {
            let y = b0 * x + memory[0];
            *memory = [b1 * x - a1 * y + memory[1], b2 * x - a2 * y];
            x = y;
        }
        x
    }
}

/// One accepted epoch.
#[derive(Clone, Debug)]
pub struct Observation {
    pub columns: Vector,
    pub x: Vector,
    pub y: f64,
    pub settled: bool,
}

/// Epochs that the estimators wait after a start: the slowest pole of `SOS`, 0.98008, to the power 344 is below 1e-3.
const SETTLING: usize = 344;

/// Checks, columns, band-pass.
#[derive(Default)]
pub struct FrontEnd {
    before: Option<(u32, [f64; 3])>,
    filter: Option<(u32, Vec<BandPass>, Vec<f64>)>,
    epochs: usize,
}

impl FrontEnd {
    /// `None` where the epoch is of no use.
    pub fn step(&mut self, epoch: &Epoch) -> Option<Observation> {
        let (scalar_pt, flux_nt) = (epoch.scalar_pt?, epoch.flux_nt?);
        let flux_nt = flux_nt.map(f64::from);
        let (tick, before_nt) = self.before.replace((epoch.tick, flux_nt))?;
        if tick + 1 != epoch.tick {
            return None;
        }
        let columns = columns(flux_nt, before_nt);
        let mut input: Vec<f64> = columns.iter().copied().collect();
        input.push(f64::from(scalar_pt) / 1000.0);
        // A dropout of up to ten epochs is held, a longer one starts anew.
        if self.filter.as_ref().is_some_and(|(last, ..)| epoch.tick - last > 11) {
            self.filter = None;
        }
        let (last, filter, held) = self.filter.get_or_insert_with(|| {
            self.epochs = 0;
            (epoch.tick - 1, input.iter().map(|&x| BandPass::steady(x)).collect(), input.clone())
        });
        for _ in *last + 1..epoch.tick {
            filter.iter_mut().zip(held.iter()).for_each(|(filter, &x)| _ = filter.step(x));
        }
        let output: Vec<f64> = filter.iter_mut().zip(&input).map(|(filter, &x)| filter.step(x)).collect();
        (*last, *held) = (epoch.tick, input);
        self.epochs += 1;
        let x = Vector::from_column_slice(&output[..18]);
        Some(Observation { columns, x, y: output[18], settled: self.epochs > SETTLING })
    }
}

/// What the recursions need of eq. (16), in its own units.
pub struct Recursion {
    pub beta: Vector,
    gamma: f64,
    lambda1: f64,
    lambda2: f64,
    renewed: bool,
    inverse_p: Matrix,
    q: Vector,
    z: Vector,
}

impl Recursion {
    /// Eqs. (16) to (18) as published, with `nu` = 0.9.
    pub fn saddle_point(beta: Vector) -> Self {
        let (lambda1, lambda2) = (0.001, 0.025);
        let (inverse_p, q) = (Matrix::identity() * lambda2, beta * lambda2);
        Self { beta, gamma: 0.9999, lambda1, lambda2, renewed: true, inverse_p, q, z: Vector::zeros() }
    }

    /// The same without dual and without renewed penalty.
    pub fn rls(beta: Vector) -> Self {
        Self { lambda1: 0.0, renewed: false, ..Self::saddle_point(beta) }
    }

    pub fn update(&mut self, x: &Vector, y: f64) {
        let renewal = if self.renewed { (1.0 - self.gamma) * self.lambda2 } else { 0.0 };
        self.inverse_p = self.inverse_p * self.gamma + x * x.transpose() + Matrix::identity() * renewal;
        self.q = self.q * self.gamma + x * y;
        let before = self.beta;
        self.beta = solve(&self.inverse_p, &(self.q - self.z));
        let raised = self.z + (self.beta * 2.0 - before) * 0.9;
        self.z = raised.map(|z| z.clamp(-self.lambda1, self.lambda1));
    }
}

/// Solve a symmetric positive definite system whose columns differ by many orders of magnitude.
pub fn solve(matrix: &Matrix, right: &Vector) -> Vector {
    let scale = matrix.diagonal().map(|value| 1.0 / value.sqrt());
    let mut l = *matrix;
    for i in 0..18 {
        for j in 0..18 {
            l[(i, j)] *= scale[i] * scale[j];
        }
    }
    let mut b = right.component_mul(&scale);
    // Cholesky in place, then two triangular solves.
    for j in 0..18 {
        for k in 0..j {
            let ljk = l[(j, k)];
            for i in j..18 {
                l[(i, j)] -= l[(i, k)] * ljk;
            }
        }
        let root = l[(j, j)].sqrt();
        for i in j..18 {
            l[(i, j)] /= root;
        }
    }
    for i in 0..18 {
        for k in 0..i {
            b[i] -= l[(i, k)] * b[k];
        }
        b[i] /= l[(i, i)];
    }
    for i in (0..18).rev() {
        for k in i + 1..18 {
            b[i] -= l[(k, i)] * b[k];
        }
        b[i] /= l[(i, i)];
    }
    b.component_mul(&scale)
}

/// Normal equations of eq. (7).
pub struct Batch {
    pub gram: Matrix,
    pub q: Vector,
}

impl Default for Batch {
    fn default() -> Self {
        Self { gram: Matrix::zeros(), q: Vector::zeros() }
    }
}

impl Batch {
    pub fn add(&mut self, x: &Vector, y: f64) {
        self.gram += x * x.transpose();
        self.q += x * y;
    }

    /// Eq. (7) by cyclic coordinate descent from the ridge solution, to convergence.
    pub fn elastic_net(&self, lambda1: f64, lambda2: f64) -> Vector {
        let penalised = self.gram + Matrix::identity() * lambda2;
        let mut beta = solve(&penalised, &self.q);
        for _ in 0..1_000_000 {
            let mut change = 0.0_f64;
            for i in 0..18 {
                let rest = self.q[i] - penalised.row(i).tr_dot(&beta) + penalised[(i, i)] * beta[i];
                let new = rest.signum() * (rest.abs() - lambda1).max(0.0) / penalised[(i, i)];
                change = change.max((new - beta[i]).abs() * penalised[(i, i)].sqrt());
                beta[i] = new;
            }
            if change < 1e-13 * self.q.amax() / penalised.diagonal().amax().sqrt() {
                break;
            }
        }
        beta
    }
}
