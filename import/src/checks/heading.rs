//! Axes from headings: as the body turns, forward and starboard follow the cosine and the sine of its heading.

use nalgebra::{Complex, Matrix2, Vector2};

use super::statistics::moments;
use crate::profile::Axis;

/// The heading must vary by this much, as standard deviation of its cosine or sine.
const TURNS: f64 = 0.2;
/// The part of the variance of the two horizontal axes that the heading must explain.
const EXPLAINED: f64 = 0.8;

/// What the headings say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// Forward, starboard and the vertical axis, of which the sign is not told.
    pub(super) axes: [Axis; 3],
}

/// Forward + i starboard = H exp(-i heading): of the three axes that could be vertical, both orders of the others, and four
/// quarter turns, those that fit best. The declination may be up to 45 degrees. `None` where the body does not turn, or
/// nothing fits.
pub(super) fn axes(flux: &[&[f64]; 3], headings_deg: &[f64], rows: &[usize]) -> Option<Found> {
    let rows: Vec<usize> = rows.iter().copied().filter(|&row| headings_deg[row].is_finite()).collect();
    let turn = |row: &usize| Complex::from_polar(1.0, -headings_deg[*row].to_radians());
    let (_, cosines) = moments(rows.iter().map(|row| turn(row).re));
    let (_, sines) = moments(rows.iter().map(|row| turn(row).im));
    if rows.len() < 100 || cosines.max(sines) < TURNS {
        return None;
    }
    let mut best: Option<(f64, usize, bool, Complex<f64>)> = None;
    for vertical in 0..3 {
        for is_mirrored in [false, true] {
            let (a, b) = ((vertical + 1) % 3, (vertical + 2) % 3);
            let sign = if is_mirrored { -1.0 } else { 1.0 };
            let horizontal = |row: &usize| Complex::new(flux[a][*row], sign * flux[b][*row]);
            let pairs = rows.iter().map(|row| (turn(row), horizontal(row)));
            if let Some((explained, strength)) = fit(pairs)
                && best.is_none_or(|(highest, ..)| explained > highest)
            {
                best = Some((explained, vertical, is_mirrored, strength));
            }
        }
    }
    let (_, vertical, is_mirrored, strength) = best.filter(|(explained, ..)| *explained > EXPLAINED)?;
    Some(named(vertical, is_mirrored, strength))
}

/// Least squares of `horizontal = strength * turn + constant`: the part of the variance explained, and the strength.
fn fit(pairs: impl Iterator<Item = (Complex<f64>, Complex<f64>)> + Clone) -> Option<(f64, Complex<f64>)> {
    let one = Complex::new(1.0, 0.0);
    let mut normal = Matrix2::<Complex<f64>>::zeros();
    let mut right = Vector2::<Complex<f64>>::zeros();
    for (turn, horizontal) in pairs.clone() {
        let row = Vector2::new(turn, one);
        normal += row.conjugate() * row.transpose();
        right += row.conjugate() * horizontal;
    }
    let solution = normal.try_inverse()? * right;
    let (mut rest, mut all) = (0.0, 0.0);
    let mean =
        pairs.clone().map(|(_, horizontal)| horizontal).sum::<Complex<f64>>() / pairs.clone().count().max(1) as f64;
    for (turn, horizontal) in pairs {
        rest += (horizontal - solution[0] * turn - solution[1]).norm_sqr();
        all += (horizontal - mean).norm_sqr();
    }
    (all > 0.0).then(|| (1.0 - rest / all, solution[0]))
}

/// The quarter turn that the strength's phase tells, as axes.
fn named(vertical: usize, is_mirrored: bool, strength: Complex<f64>) -> Found {
    let (a, b) = ((vertical + 1) % 3, (vertical + 2) % 3);
    let (real, imaginary) = (Axis { of: a, is_turned: false }, Axis { of: b, is_turned: is_mirrored });
    let turned = |axis: Axis| Axis { is_turned: !axis.is_turned, ..axis };
    // a + i b = strength exp(-i heading): divided by the phase, to the next quarter, it is forward + i starboard.
    let quarters = (strength.arg() / std::f64::consts::FRAC_PI_2).round() as i32;
    let [forward, starboard] = match quarters.rem_euclid(4) {
        0 => [real, imaginary],
        1 => [imaginary, turned(real)],
        2 => [turned(real), turned(imaginary)],
        _ => [turned(imaginary), real],
    };
    let found = [forward, starboard, Axis { of: vertical, is_turned: false }];
    Found { axes: found }
}
