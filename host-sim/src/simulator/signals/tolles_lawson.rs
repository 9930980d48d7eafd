//! The Tolles-Lawson model of eq. (4) in `f64`: the interfering vector, `A beta`, its 18 columns and its slopes.
//!
//! Written from the equation, independently of the core's `f32` model (`towmag::model::Terms`), with the true time
//! derivative in place of the core's backward difference, and with all 18 columns where the core uses a reduced basis.
//! Simulator, regression and noise model all take the model from here.
//!
//! Units: `c` is the unit vector of the field in body axes, `rate` its time derivative, 1/s. Coefficients are those of
//! eq. (4): 3 permanent (nT), 6 induced (nT/nT; xx, xy, xz, yy, yz, zz), 9 eddy (s; row `i`, column `j` multiplies
//! `c_i dc_j/dt`).

use towmag::model::TERMS;

/// Field for which the columns of a fit are given, nT: their induced and eddy coefficients are those of eq. (4) times
/// this, so that all 18 are of the same order (the core's `UNIT_FIELD_NT`).
pub(crate) const UNIT_FIELD_NT: f64 = towmag::model::UNIT_FIELD_NT as f64;

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

/// Derivatives of `A beta`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    /// By each component of the direction, nT, of a body at rest: the eddy part, which is in proportion to the rate, is
    /// left out.
    pub(crate) by_direction_nt: [f64; 3],
    /// By each component of the direction's rate, nT s.
    pub(crate) by_rate_nt_s: [f64; 3],
}

/// Interference for a field `field_nt` in direction `c`, which changes by `rate` per second.
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

/// One row of the design matrix `A`: the 18 columns of eq. (4).
///
/// `field` is in nT for the coefficients of eq. (4), or in units of [`UNIT_FIELD_NT`] for those of a fit.
pub(crate) fn columns(field: f64, c: [f64; 3], rate: [f64; 3]) -> [f64; TERMS] {
    let mut columns = [0.0; TERMS];
    columns[..3].copy_from_slice(&c);
    let pairs = (0..3).flat_map(|i| (i..3).map(move |j| (i, j)));
    let induced = pairs.map(|(i, j)| field * c[i] * c[j]);
    let eddy = c.into_iter().flat_map(|cosine| rate.map(|change| field * cosine * change));
    columns[3..].iter_mut().zip(induced.chain(eddy)).for_each(|(column, value)| *column = value);
    columns
}

/// The slopes of `A beta` for a field `field_nt` in direction `c`: what an error of the direction, or of its rate, does.
pub(crate) fn slopes(coefficients: &[f64; TERMS], field_nt: f64, c: [f64; 3]) -> Slopes {
    let [px, py, pz, induced @ .., _, _, _, _, _, _, _, _, _] = coefficients;
    let [xx, xy, xz, yy, yz, zz] = induced.map(|coefficient: f64| coefficient * field_nt);
    let eddy = &coefficients[9..];
    Slopes {
        by_direction_nt: [
            px + 2.0 * xx * c[0] + xy * c[1] + xz * c[2],
            py + xy * c[0] + 2.0 * yy * c[1] + yz * c[2],
            pz + xz * c[0] + yz * c[1] + 2.0 * zz * c[2],
        ],
        by_rate_nt_s: [0, 1, 2].map(|j| (0..3).map(|i| field_nt * c[i] * eddy[3 * i + j]).sum::<f64>()),
    }
}
