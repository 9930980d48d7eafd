//! `A beta` of eq. (4) and the vector whose projection it is.

use towmag::model::TERMS;

/// `A beta` in its three parts, nT.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interference {
    /// Of the permanent magnetisation.
    pub permanent_nt: f64,
    /// Of the magnetisation that the field induces.
    pub induced_nt: f64,
    /// Of the eddy currents.
    pub eddy_nt: f64,
}

impl Interference {
    /// All three.
    pub fn total_nt(&self) -> f64 {
        self.permanent_nt + self.induced_nt + self.eddy_nt
    }
}

/// Interference for a field `field_nt` in direction `c`, which changes by `rate` per second; coefficients as in eq. (4).
pub fn interference(coefficients: &[f64; TERMS], field_nt: f64, c: [f64; 3], rate: [f64; 3]) -> Interference {
    let vector = vector_nt(coefficients, field_nt, c, rate);
    let along = |part: [f64; 3]| c[0] * part[0] + c[1] * part[1] + c[2] * part[2];
    let [permanent, induced, eddy] = vector;
    Interference { permanent_nt: along(permanent), induced_nt: along(induced), eddy_nt: along(eddy) }
}

/// The interfering vector in body axes, nT: permanent, induced (by a symmetric matrix) and eddy part.
///
/// Its projection on `c` is `A beta`; eq. (4) holds each product of two different cosines once, the matrix twice.
pub fn vector_nt(coefficients: &[f64; TERMS], field_nt: f64, c: [f64; 3], rate: [f64; 3]) -> [[f64; 3]; 3] {
    let [px, py, pz, xx, xy, xz, yy, yz, zz, eddy @ ..] = coefficients;
    let induced = [
        field_nt * (xx * c[0] + 0.5 * (xy * c[1] + xz * c[2])),
        field_nt * (yy * c[1] + 0.5 * (xy * c[0] + yz * c[2])),
        field_nt * (zz * c[2] + 0.5 * (xz * c[0] + yz * c[1])),
    ];
    let eddy = std::array::from_fn(|i| {
        field_nt * (eddy[3 * i] * rate[0] + eddy[3 * i + 1] * rate[1] + eddy[3 * i + 2] * rate[2])
    });
    [[*px, *py, *pz], induced, eddy]
}
