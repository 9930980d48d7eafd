//! What the same bits everywhere rest on. These tests are built together with host-sim, which asks for `nalgebra`'s
//! `std`; the firmware is built without it. The emulated firmware, which `host-sim/tests/host/emulate.rs` holds against the
//! replay, shows the same from the other side.

use nalgebra::{ComplexField, SMatrix};
use towmag::model::{TERMS, TermVector};

/// Numbers of all sizes and both signs, the same everywhere.
fn number(k: usize) -> f32 {
    let bits = (k as u32).wrapping_mul(2_654_435_761).wrapping_add(0x9e37_79b9);
    (bits as f32 / 4.3e9 - 0.5) * libm::exp2f((bits % 24) as f32 - 12.0)
}

fn vector(first: usize) -> TermVector {
    TermVector::from_fn(|i, _| number(first + i))
}

#[test]
fn functions_are_those_of_libm() {
    for x in (0..10_000).map(number) {
        let pairs = [
            (ComplexField::sin(x), libm::sinf(x)),
            (ComplexField::exp(x), libm::expf(x)),
            (ComplexField::abs(x), libm::fabsf(x)),
            (ComplexField::sqrt(x.abs()), libm::sqrtf(x.abs())),
            (ComplexField::ln(x.abs()), libm::logf(x.abs())),
        ];
        assert!(pairs.iter().all(|(ours, libms)| ours.to_bits() == libms.to_bits()), "{x}: {pairs:?}");
    }
}

/// Eight partial sums, these pairwise, then the rest one by one.
#[test]
fn a_dot_product_sums_in_its_order() {
    for (a, b) in (0..1000).map(|k| (vector(97 * k), vector(131 * k + 7))) {
        let mut partial = [0.0_f32; 8];
        for i in 0..16 {
            partial[i % 8] += a[i] * b[i];
        }
        let pairwise = (0..4).fold(0.0, |sum, i| sum + (partial[i] + partial[i + 4]));
        let expected = (16..TERMS).fold(pairwise, |sum, i| sum + a[i] * b[i]);
        assert_eq!(a.dot(&b).to_bits(), expected.to_bits());
    }
}

/// A product of matrices sums over the inner index in ascending order, whatever their size.
#[test]
fn a_product_sums_in_its_order() {
    type Square = SMatrix<f32, 17, 17>;
    let a = Square::from_fn(|i, j| number(17 * i + j));
    let b = Square::from_fn(|i, j| number(i + 31 * j));
    let expected = Square::from_fn(|i, j| (1..17).fold(a[(i, 0)] * b[(0, j)], |sum, k| sum + a[(i, k)] * b[(k, j)]));
    assert_eq!((a * b).map(f32::to_bits), expected.map(f32::to_bits));
    let x = vector(3);
    let matrix = SMatrix::<f32, TERMS, TERMS>::from_fn(|i, j| number(i + 18 * j));
    let expected =
        TermVector::from_fn(|i, _| (1..TERMS).fold(matrix[(i, 0)] * x[0], |sum, k| sum + matrix[(i, k)] * x[k]));
    assert_eq!((matrix * x).map(f32::to_bits), expected.map(f32::to_bits));
}
