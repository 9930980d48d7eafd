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

/// Weights of the derivative in the middle of seven points: right to 0.04 % at 1 Hz, where the difference of two neighbours is 6 %
/// short. A body that is shaken at 1 Hz has eddy currents of tens of nT, and its targets are sought in hundredths.
const MIDDLE: [f64; 7] = [-1.0 / 60.0, 3.0 / 20.0, -3.0 / 4.0, 0.0, 3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0];
/// Where the seven would go beyond the stretch: at the first, second and third of five points, 3 % wrong at 1 Hz at the most. A
/// difference of the last two is that of half a row before, and in a turn it is off by several nT.
const BESIDE_END: [[f64; 5]; 3] = [
    [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -1.0 / 4.0],
    [-1.0 / 4.0, -5.0 / 6.0, 3.0 / 2.0, -1.0 / 2.0, 1.0 / 12.0],
    [1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0],
];

/// The 18 terms of each row of a stretch without gaps, in nT a unit coefficient: permanent coefficients in nT, induced ones in
/// parts of 50,000 nT, eddy ones in nT s at 50,000 nT. The derivative is a central one, without delay.
///
/// Induced and eddy ones are those of one field for all rows, `field_nt`. With the magnitude as read, row by row, the terms come
/// near that magnitude itself where directions are few, and a fluxgate has targets and background in it: coefficients of 80,000 nT
/// then took both off the field. A field that changes by 500 nT changes an induced 100 nT by 1.
pub(crate) fn of_stretch(time_s: &[f64], flux_nt: &[[f64; 3]], rows: Range<usize>, field_nt: f64) -> Vec<[f64; TERMS]> {
    let directions: Vec<[f64; 3]> = flux_nt[rows.clone()].iter().map(|flux_nt| direction(*flux_nt)).collect();
    let rate = |row: usize| rate_of(&time_s[rows.clone()], &directions, row);
    directions.iter().enumerate().map(|(row, direction)| terms(*direction, rate(row), field_nt)).collect()
}

/// Rate of the directions of a stretch at one of its rows, 1/s.
fn rate_of(time_s: &[f64], directions: &[[f64; 3]], row: usize) -> [f64; 3] {
    let last = directions.len() - 1;
    let from_end = row.min(last - row);
    if from_end >= BESIDE_END.len() {
        weighted(time_s, directions, std::array::from_fn(|k| row - 3 + k), &MIDDLE)
    } else if last < 4 {
        weighted(time_s, directions, [row.max(1) - 1, (row + 1).min(last)], &[-1.0, 1.0])
    } else if row == from_end {
        weighted(time_s, directions, std::array::from_fn(|k| k), &BESIDE_END[from_end])
    } else {
        weighted(time_s, directions, std::array::from_fn(|k| last - k), &BESIDE_END[from_end])
    }
}

/// The weighted sum of the directions at some rows evenly apart, over the time from one to the next.
fn weighted<const ROWS: usize>(
    time_s: &[f64],
    directions: &[[f64; 3]],
    rows: [usize; ROWS],
    weights: &[f64; ROWS],
) -> [f64; 3] {
    let step_s = (time_s[rows[ROWS - 1]] - time_s[rows[0]]) / (ROWS - 1) as f64;
    let step_s = if step_s == 0.0 { f64::MIN_POSITIVE } else { step_s };
    let mut rate = [0.0; 3];
    for (row, weight) in rows.into_iter().zip(weights) {
        (0..3).for_each(|axis| rate[axis] += weight * directions[row][axis] / step_s);
    }
    rate
}

fn terms([x, y, z]: [f64; 3], rate: [f64; 3], field_nt: f64) -> [f64; TERMS] {
    let field = field_nt / UNIT_FIELD_NT;
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
        let flux_nt = [[2e4, 1e4, 4e4], [2.1e4, 0.9e4, 4e4], [2.1e4, 0.8e4, 4.1e4]];
        let rows = of_stretch(&[0.0, 0.1, 0.2], &flux_nt, 0..3, 46_000.0);
        let coefficients: [f64; TERMS] = std::array::from_fn(|term| (7 * term % 11) as f64 - 4.0);
        let told = expand(&combine(&coefficients));
        let product = |a: &[f64; TERMS], b: &[f64; TERMS]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let third = (coefficients[3] + coefficients[6] + coefficients[8]) / 3.0;
        for (row, terms) in rows.iter().enumerate() {
            // What is left out is the mean of the diagonal, a constant. The derivative of a unit vector is across it only to the
            // second order of the step.
            let left = product(terms, &coefficients) - product(terms, &told);
            assert!((left - third * 0.92).abs() < 0.02, "{row}: {left}");
        }
    }

    /// A direction that swings by 0.1 rad at 0.7 Hz.
    #[test]
    fn the_rate_is_right_up_to_both_ends() {
        let angle = |row: usize| (std::f64::consts::TAU * 0.7 * 0.1 * row as f64 + 0.4).sin_cos();
        let flux_nt: Vec<[f64; 3]> =
            (0..20).map(|row| [5e4 * (0.1 * angle(row).0).sin(), 0.0, 5e4 * (0.1 * angle(row).0).cos()]).collect();
        let time_s: Vec<f64> = (0..20).map(|row| 0.1 * row as f64).collect();
        let directions: Vec<[f64; 3]> = flux_nt.iter().map(|flux_nt| direction(*flux_nt)).collect();
        for row in 0..20 {
            let exact = 0.1 * std::f64::consts::TAU * 0.7 * angle(row).1 * (0.1 * angle(row).0).cos();
            let found = rate_of(&time_s, &directions, row)[0];
            let allowed = if (3..17).contains(&row) { 2e-3 } else { 3e-2 } * 0.1 * std::f64::consts::TAU * 0.7;
            assert!((found - exact).abs() < allowed, "{row}: {found} {exact}");
        }
        let two = rate_of(&time_s[..2], &directions[..2], 1)[0];
        assert!((two - (flux_nt[1][0] - flux_nt[0][0]) / 5e3).abs() < 1e-9, "{two}");
    }
}
