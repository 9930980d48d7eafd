//! Singular values of a factor, for its condition number.

use crate::model::{TERMS, TermVector};

/// Sweeps after which one-sided Jacobi of an 18 x 18 matrix has long converged (it takes 6 to 10).
const SWEEPS: usize = 20;

/// Singular values of a square matrix given by its rows, largest first, by one-sided Jacobi rotations (Hestenes 1958;
/// Golub and Van Loan, "Matrix Computations", 4th ed., 8.6.3): accurate for the small ones too, without a panic.
pub fn singular_values(rows: &[TermVector; TERMS]) -> TermVector {
    let mut rows = *rows;
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..TERMS {
            for q in p + 1..TERMS {
                let (head, tail) = rows.split_at_mut(q);
                rotated |= orthogonalise(&mut head[p], &mut tail[0]);
            }
        }
        if !rotated {
            break;
        }
    }
    let mut values = rows.map(|row| libm::sqrtf(dot(&row, &row)));
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values
}

/// Rotate two vectors in their plane until they are orthogonal. False when they already are.
fn orthogonalise(p: &mut TermVector, q: &mut TermVector) -> bool {
    let (pp, qq, pq) = (dot(p, p), dot(q, q), dot(p, q));
    if pq == 0.0 || libm::fabsf(pq) <= f32::EPSILON * libm::sqrtf(pp) * libm::sqrtf(qq) {
        return false;
    }
    let zeta = (qq - pp) / (2.0 * pq);
    let tangent = libm::copysignf(1.0, zeta) / (libm::fabsf(zeta) + libm::hypotf(1.0, zeta));
    let cosine = 1.0 / libm::hypotf(1.0, tangent);
    let sine = cosine * tangent;
    for (p, q) in p.iter_mut().zip(q) {
        (*p, *q) = (cosine * *p - sine * *q, sine * *p + cosine * *q);
    }
    true
}

fn dot(a: &TermVector, b: &TermVector) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
