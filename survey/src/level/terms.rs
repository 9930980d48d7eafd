//! The 18 terms of eq. (4), less what no recording can tell of them.

use std::ops::Range;

/// Field for which induced and eddy columns are given, nT: their coefficients are those of eq. (4) times this.
pub(crate) const UNIT_FIELD_NT: f64 = 50_000.0;
/// Terms of eq. (4).
pub(crate) const TERMS: usize = 18;
/// Combinations of them that a recording can tell: the squares of the direction cosines sum to one, and the products of each
/// with its own derivative to nothing.
pub(crate) const TOLD: usize = 16;
/// What is fitted: those, and in the band of targets also what a fluxgate does of its own, its magnitude and the square of the
/// direction's rate.
pub(crate) const COMBINATIONS: usize = TOLD + 2;
/// Place of the fluxgate's magnitude.
pub(crate) const MAGNITUDE: usize = TOLD;

/// Direction cosines of the field in body axes; NaN where the fluxgate gives none.
pub(crate) fn direction(flux_nt: [f64; 3]) -> [f64; 3] {
    let magnitude = magnitude(flux_nt);
    flux_nt.map(|axis| axis / magnitude)
}

pub(crate) fn magnitude([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Weights of the derivative of a sine of seven points: right to 0.04 % at 1 Hz, where the difference of two neighbours is 6 %
/// short. A body that is shaken at 1 Hz has eddy currents of tens of nT, and its targets are sought in hundredths.
const DERIVATIVES: [&[f64]; 3] = [&[1.0 / 2.0], &[2.0 / 3.0, -1.0 / 12.0], &[3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0]];

/// The 18 terms of each row of a stretch without gaps, in nT a unit coefficient: permanent coefficients in nT, induced ones in
/// parts of 50,000 nT, eddy ones in nT s at 50,000 nT. The derivative is a central one, without delay.
pub(crate) fn of_stretch(time_s: &[f64], flux_nt: &[[f64; 3]], rows: Range<usize>) -> Vec<[f64; TERMS]> {
    rows.clone().map(|row| terms(flux_nt[row], rate_of(time_s, flux_nt, row, &rows))).collect()
}

/// Rate of the direction at a row, 1/s: of as many points as the stretch has on both sides, seven at most.
fn rate_of(time_s: &[f64], flux_nt: &[[f64; 3]], row: usize, rows: &Range<usize>) -> [f64; 3] {
    let sides = (row - rows.start).min(rows.end - 1 - row).min(DERIVATIVES.len());
    let difference = |first: usize, last: usize| {
        let [from, to] = [first, last].map(|row| direction(flux_nt[row]));
        [0, 1, 2].map(|axis| to[axis] - from[axis])
    };
    if sides == 0 {
        let (first, last) = (row.max(rows.start + 1) - 1, (row + 1).min(rows.end - 1));
        let over_s = (time_s[last] - time_s[first]).max(f64::MIN_POSITIVE);
        return difference(first, last).map(|change| change / over_s);
    }
    let step_s = (time_s[row + sides] - time_s[row - sides]) / (2 * sides) as f64;
    let mut rate = [0.0; 3];
    for (off, weight) in DERIVATIVES[sides - 1].iter().enumerate() {
        let change = difference(row - off - 1, row + off + 1);
        (0..3).for_each(|axis| rate[axis] += weight * change[axis] / step_s.max(f64::MIN_POSITIVE));
    }
    rate
}

fn terms(flux_nt: [f64; 3], rate: [f64; 3]) -> [f64; TERMS] {
    let [x, y, z] = direction(flux_nt);
    let field = magnitude(flux_nt) / UNIT_FIELD_NT;
    let [dx, dy, dz] = rate.map(|rate| field * rate);
    let induced = [x * x, x * y, x * z, y * y, y * z, z * z].map(|product| field * product);
    let eddy = [x * dx, x * dy, x * dz, y * dx, y * dy, y * dz, z * dx, z * dy, z * dz];
    let mut all = [0.0; TERMS];
    all[..3].copy_from_slice(&[x, y, z]);
    all[3..9].copy_from_slice(&induced);
    all[9..].copy_from_slice(&eddy);
    all
}

/// The combinations that can be told, of a row of terms; also the combinations of coefficients, as the basis is orthonormal.
pub(crate) fn combine(terms: &[f64; TERMS]) -> [f64; TOLD] {
    let [px, py, pz, xx, xy, xz, yy, yz, zz, exx, exy, exz, eyx, eyy, eyz, ezx, ezy, ezz] = *terms;
    let [induced_1, induced_2] = contrasts(xx, yy, zz);
    let [eddy_1, eddy_2] = contrasts(exx, eyy, ezz);
    [px, py, pz, induced_1, induced_2, xy, xz, yz, eddy_1, eddy_2, exy, exz, eyx, eyz, ezx, ezy]
}

/// The 18 coefficients of combinations.
pub(crate) fn expand(combinations: &[f64; TOLD]) -> [f64; TERMS] {
    let [px, py, pz, induced_1, induced_2, xy, xz, yz, eddy_1, eddy_2, exy, exz, eyx, eyz, ezx, ezy] = *combinations;
    let [xx, yy, zz] = diagonal(induced_1, induced_2);
    let [exx, eyy, ezz] = diagonal(eddy_1, eddy_2);
    [px, py, pz, xx, xy, xz, yy, yz, zz, exx, exy, exz, eyx, eyy, eyz, ezx, ezy, ezz]
}

/// The two orthonormal contrasts of three values whose sum says nothing.
fn contrasts(x: f64, y: f64, z: f64) -> [f64; 2] {
    [(x - y) / 2_f64.sqrt(), (x + y - 2.0 * z) / 6_f64.sqrt()]
}

fn diagonal(first: f64, second: f64) -> [f64; 3] {
    let (a, b) = (first / 2_f64.sqrt(), second / 6_f64.sqrt());
    [a + b, b - a, -2.0 * b]
}

/// Number of scaled coefficients in one unit of eq. (4).
pub(crate) fn scale_of(term: usize) -> f64 {
    if term < 3 { 1.0 } else { UNIT_FIELD_NT }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn combinations_leave_out_constants_alone() {
        let rows = of_stretch(&[0.0, 0.1, 0.2], &[[2e4, 1e4, 4e4], [2.1e4, 0.9e4, 4e4], [2.1e4, 0.8e4, 4.1e4]], 0..3);
        let coefficients: [f64; TERMS] = std::array::from_fn(|term| (7 * term % 11) as f64 - 4.0);
        let told = expand(&combine(&coefficients));
        let product = |a: &[f64; TERMS], b: &[f64; TERMS]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let field = |row: usize| {
            [2e4_f64, 2.1e4, 2.1e4][row].hypot([1e4, 0.9e4, 0.8e4][row]).hypot([4e4, 4e4, 4.1e4][row]) / UNIT_FIELD_NT
        };
        let third = (coefficients[3] + coefficients[6] + coefficients[8]) / 3.0;
        for (row, terms) in rows.iter().enumerate() {
            // What is left out is the mean of the diagonal: a constant where the field is one. The derivative of a unit
            // vector is across it only to the second order of the step.
            let left = product(terms, &coefficients) - product(terms, &told);
            assert!((left - third * field(row)).abs() < 0.02, "{row}: {left}");
        }
    }
}
