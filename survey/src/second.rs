//! A second scalar sensor: both are compensated alike, and what they have in common is told from what each has of its own.

use crate::level::{Level, slow_part_by};
use crate::statistics::median;
use crate::tow::Tow;

/// A second sensor counts where it has a reading in this share of the usable rows.
const LEAST_SHARE: f64 = 0.9;
/// Two sensors on one body read fields that differ by no more than this share.
const MOST_APART: f64 = 0.1;
/// A sensor stands still if it reads the same for so many rows, 5 s, while the other one changes by more than this, nT: coarse readings
/// are of a tenth.
const STUCK_ROWS: usize = 50;
const STUCK_NT: f64 = 0.5;
/// Noise is what is quicker than this, rows: 10 s.
const QUICK_ROWS: f64 = 100.0;
/// Over so many rows variances are taken; their median over the recording feels no target.
const PIECE_ROWS: usize = 600;

/// What two scalar sensors say together; a value a row, NaN where either has none.
#[derive(Clone, Debug, Default)]
pub struct SecondScalar {
    /// Compensated total field of the second sensor at its level, nT.
    pub field_nt: Vec<f64>,
    /// The first sensor's field less the second's, nT: without what is common to both, the day and waves above.
    pub difference_nt: Vec<f64>,
    /// Half the sum of both, nT.
    pub mean_nt: Vec<f64>,
    /// What is common to both and quicker than 10 s, as a standard deviation, nT: not of the sensors.
    pub common_nt: f64,
    /// What each has of its own, first and second, nT.
    pub own_nt: [f64; 2],
}

/// The recordings as the second sensor has them; `None` unless all of them have one.
pub(crate) fn as_second(tows: &[Tow]) -> Option<Vec<Tow>> {
    tows.iter().map(of_second).collect()
}

fn of_second(tow: &Tow) -> Option<Tow> {
    let scalar_nt = tow.scalar2_nt.clone()?;
    let is_read = readings(&tow.scalar_nt, &scalar_nt);
    let is_usable: Vec<bool> =
        tow.is_usable.iter().zip(is_read).map(|(is_usable, is_read)| *is_usable && is_read).collect();
    let count = |usable: &[bool]| usable.iter().filter(|is_usable| **is_usable).count() as f64;
    let is_enough = count(&is_usable) >= LEAST_SHARE * count(&tow.is_usable);
    is_enough.then(|| Tow { scalar_nt, is_usable, scalar_variance_nt2: None, ..tow.clone() })
}

/// Which rows of the second sensor are readings: near the first sensor's field, and not the same for long while that changes.
fn readings(first_nt: &[f64], second_nt: &[f64]) -> Vec<bool> {
    let is_field = |(first, second): (&f64, &f64)| (second - first).abs() <= MOST_APART * first.abs();
    let mut is_read: Vec<bool> = first_nt.iter().zip(second_nt).map(is_field).collect();
    let mut begin = 0;
    for same in second_nt.chunk_by(|a, b| a == b) {
        let rows = begin..begin + same.len();
        begin = rows.end;
        let ends = first_nt[rows.clone()].iter().filter(|nt| nt.is_finite());
        let [least, most] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], nt| [a.min(*nt), b.max(*nt)]);
        if rows.len() >= STUCK_ROWS && most - least > STUCK_NT {
            is_read[rows].fill(false);
        }
    }
    is_read
}

/// Both together, for the rows of one recording.
pub(crate) fn together(first: &Level, second: &Level, rows: std::ops::Range<usize>) -> SecondScalar {
    let (a, b) = (&first.field_nt[rows.clone()], &second.field_nt[rows]);
    let pairs = || a.iter().zip(b);
    let (common_nt, own_nt) = noises(a, b);
    SecondScalar {
        field_nt: b.to_vec(),
        difference_nt: pairs().map(|(a, b)| a - b).collect(),
        mean_nt: pairs().map(|(a, b)| 0.5 * (a + b)).collect(),
        common_nt,
        own_nt,
    }
}

/// Standard deviations of what is common and of what each has of its own: covariance, and variance less covariance.
fn noises(a: &[f64], b: &[f64]) -> (f64, [f64; 2]) {
    let weights: Vec<f64> = a.iter().zip(b).map(|(a, b)| f64::from(u8::from((a + b).is_finite()))).collect();
    let quick = |values: &[f64]| {
        let slow = slow_part_by(std::slice::from_ref(&(0..values.len())), values, &weights, QUICK_ROWS);
        values.iter().zip(slow).map(|(value, slow)| value - slow).collect::<Vec<f64>>()
    };
    let (a, b) = (quick(a), quick(b));
    let moments = |begin: usize| {
        let rows = (begin..(begin + PIECE_ROWS).min(a.len())).filter(|&row| weights[row] > 0.0);
        let sums = rows.fold([0.0; 4], |[n, aa, bb, ab], row| {
            [n + 1.0, aa + a[row] * a[row], bb + b[row] * b[row], ab + a[row] * b[row]]
        });
        (sums[0] > 0.5 * PIECE_ROWS as f64).then(|| [1, 2, 3].map(|k| sums[k] / sums[0]))
    };
    let pieces: Vec<[f64; 3]> = (0..a.len()).step_by(PIECE_ROWS).filter_map(moments).collect();
    let [aa, bb, ab] =
        [0, 1, 2].map(|k| median(&mut pieces.iter().map(|piece| piece[k]).collect::<Vec<_>>()).unwrap_or(f64::NAN));
    let common = ab.max(0.0);
    (common.sqrt(), [aa, bb].map(|own| (own - common).max(0.0).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// White noise of variance one.
    fn noise(seed: u64, rows: usize) -> Vec<f64> {
        StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(seed)).take(rows).collect()
    }

    #[test]
    fn what_is_common_is_told_from_what_is_not() {
        let [common, first, second] = [1, 2, 3].map(|seed| noise(seed, 12_000));
        let target = |row: usize| 80.0 / (1.0 + ((row as f64 - 6_000.0) / 15.0).powi(2)).powf(2.5);
        let a: Vec<f64> = (0..12_000).map(|row| 5e4 + 0.3 * common[row] + 0.1 * first[row] + target(row)).collect();
        let b: Vec<f64> = (0..12_000).map(|row| 5e4 + 0.3 * common[row] + 0.2 * second[row] + target(row)).collect();
        let (common_nt, own_nt) = noises(&a, &b);
        assert!((common_nt - 0.3).abs() < 0.02, "{common_nt}");
        assert!((own_nt[0] - 0.1).abs() < 0.02 && (own_nt[1] - 0.2).abs() < 0.02, "{own_nt:?}");
    }

    #[test]
    fn a_second_sensor_with_many_holes_does_not_count() {
        let tow = |holes: usize| Tow {
            time_s: (0..100).map(|row| 0.1 * row as f64).collect(),
            is_usable: vec![true; 100],
            scalar_nt: vec![5e4; 100],
            scalar2_nt: Some((0..100).map(|row| if row < holes { f64::NAN } else { 5e4 }).collect()),
            ..Tow::default()
        };
        assert!(as_second(&[tow(5)]).is_some_and(|second| !second[0].is_usable[4] && second[0].is_usable[5]));
        assert!(as_second(&[tow(20)]).is_none());
        assert!(as_second(&[tow(5), Tow::default()]).is_none());
    }

    #[test]
    fn a_second_sensor_that_stands_still_or_reads_no_field_does_not_count() {
        let first: Vec<f64> = noise(4, 1000).iter().map(|nt| 5e4 + nt).collect();
        let with = |second: &dyn Fn(usize) -> f64| {
            let scalar2_nt = Some((0..1000).map(second).collect());
            let tow = Tow { is_usable: vec![true; 1000], scalar_nt: first.clone(), scalar2_nt, ..Tow::default() };
            as_second(&[tow]).is_some()
        };
        assert!(with(&|row| first[row] + 300.0) && with(&|row| (10.0 * first[row]).round() / 10.0));
        assert!(!with(&|_| 0.0) && !with(&|row| if row < 500 { first[row] } else { 5e4 }));
    }
}
