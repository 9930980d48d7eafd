//! The body's own field: 18 coefficients, and what they make of a direction and its rate.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::vector::{Vector, dot};
use crate::random::Random;

/// Permanent, induced and eddy-current interference.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// nT.
    pub(super) permanent_nt: Vector,
    /// Symmetric, nT/nT.
    pub(super) induced: [Vector; 3],
    /// s.
    pub(super) eddy_s: [Vector; 3],
}

impl Body {
    /// A body that is quiet or loud; one of five is up to five times as loud as any.
    pub(super) fn draw(draw: &mut Random) -> Self {
        let mut loud = 20.0_f64.powf(draw.random::<f64>()) * 0.15;
        if draw.random_bool(0.2) {
            loud *= libm::pow(5.0, draw.random::<f64>());
        }
        let mut entry = |scale: f64| -> f64 {
            let normal: f64 = StandardNormal.sample(draw);
            loud * scale * normal
        };
        let permanent_nt = std::array::from_fn(|_| entry(40.0));
        let [xx, xy, xz, yy, yz, zz] = std::array::from_fn(|_| entry(5e-4));
        let induced = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let eddy_s = std::array::from_fn(|_| std::array::from_fn(|_| entry(3e-4)));
        Self { permanent_nt, induced, eddy_s }
    }

    /// Interference as a vector less its eddy part, nT.
    pub(super) fn still_nt(&self, field_nt: f64, direction: Vector) -> Vector {
        std::array::from_fn(|i| self.permanent_nt[i] + field_nt * dot(self.induced[i], direction))
    }

    /// The eddy part as a vector, nT; `rate` is that of the direction, 1/s.
    pub(super) fn eddy_nt(&self, field_nt: f64, rate: Vector) -> Vector {
        std::array::from_fn(|i| field_nt * dot(self.eddy_s[i], rate))
    }
}

/// The 18 columns, in units that are alike: linear, quadratic and rate terms of the direction.
pub(crate) fn columns(direction: Vector, rate: Vector) -> [f64; 18] {
    let ([x, y, z], [u, v, w]) = (direction, rate);
    [x, y, z, x * x, x * y, x * z, y * y, y * z, z * z, x * u, x * v, x * w, y * u, y * v, y * w, z * u, z * v, z * w]
}
