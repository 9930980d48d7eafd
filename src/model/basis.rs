//! The basis that the core computes in: the 18 terms of eq. (4), with each sum that hides a large coefficient made a
//! column of its own.
//!
//! The diagonal induced terms xx + yy + zz sum to the field's magnitude, the diagonal eddy terms to nearly nothing.
//! So their three coefficients have a large common part (15,000 nT on a real calibration) that hardly acts, and in
//! f32 the rounding of that part alone costs 0.0016 nT of residual. Here the zz column is replaced by the sum itself,
//! computed without cancellation; the xx and yy coefficients are then differences from zz. It is an exact change of
//! variables: [`to_terms`] is `T` in `beta = T theta`, and penalties, duals and gradients move with it.

use super::TermVector;

/// The diagonal terms xx, yy, zz of the induced and of the eddy group; the last holds the sum.
pub(crate) const DIAGONALS: [[usize; 3]; 2] = [[3, 6, 8], [9, 13, 17]];

/// `T theta`: coefficients of the terms from those of the basis.
pub(crate) fn to_terms(theta: &TermVector) -> TermVector {
    let mut beta = *theta;
    for [xx, yy, sum] in DIAGONALS {
        beta[xx] += theta[sum];
        beta[yy] += theta[sum];
    }
    beta
}

/// `T' z`: a dual of the terms as a dual of the basis.
pub(crate) fn dual_from_terms(dual: &TermVector) -> TermVector {
    let mut moved = *dual;
    for [xx, yy, sum] in DIAGONALS {
        moved[sum] += dual[xx] + dual[yy];
    }
    moved
}

/// `T'^-1 g`: a gradient by the basis as a gradient by the terms.
pub(crate) fn gradient_to_terms(gradient: &TermVector) -> TermVector {
    let mut moved = *gradient;
    for [xx, yy, sum] in DIAGONALS {
        moved[sum] -= gradient[xx] + gradient[yy];
    }
    moved
}

/// Columns of the terms from columns of the basis: the sum becomes zz again.
pub(crate) fn columns_to_terms(columns: &TermVector) -> TermVector {
    gradient_to_terms(columns)
}

/// The column beside `term` in which its penalty also acts.
pub(crate) fn partner(term: usize) -> Option<usize> {
    DIAGONALS.iter().find(|[xx, yy, _]| term == *xx || term == *yy).map(|[.., sum]| *sum)
}

/// Make the coefficient of one term zero and leave those of the others.
pub(crate) fn set_zero(theta: &mut TermVector, term: usize) {
    match (partner(term), DIAGONALS.iter().find(|[.., sum]| term == *sum)) {
        (Some(sum), _) => theta[term] = -theta[sum],
        (None, Some([xx, yy, sum])) => {
            theta[*xx] += theta[*sum];
            theta[*yy] += theta[*sum];
            theta[*sum] = 0.0;
        }
        (None, None) => theta[term] = 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn theta() -> TermVector {
        TermVector::from_fn(|i, _| i as f32 + 1.0)
    }

    #[test]
    fn products_are_the_same_in_both() {
        let (theta, other) = (theta(), TermVector::from_fn(|i, _| (i * i % 7) as f32 - 3.0));
        assert_eq!(to_terms(&theta).dot(&columns_to_terms(&other)), theta.dot(&other));
        assert_eq!(to_terms(&theta).dot(&other), theta.dot(&dual_from_terms(&other)));
    }

    #[test]
    fn one_term_becomes_zero_alone() {
        for term in 0..theta().len() {
            let mut theta = theta();
            set_zero(&mut theta, term);
            let mut expected = to_terms(&self::theta());
            expected[term] = 0.0;
            assert_eq!(to_terms(&theta), expected, "term {term}");
        }
    }
}
