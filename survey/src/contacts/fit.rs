//! The dipole that fits a window best, and what else may have made it.

use nalgebra::{DMatrix, SVector};
use statrs::distribution::{ContinuousCDF, Normal};

use super::dipole::Dipole;
use super::window::{Fitted, Window};
use crate::level::MODEL_ERROR;

/// First steps of the search by place, in distances, and by the logarithm of the distance: those of the detector's grid; by the side.
const FIRST_STEPS: [f64; 3] = [0.1, 0.1, 0.2];
/// Last ones: a hundredth of the standard deviations at a signal to noise of 15.
const LAST_STEP: f64 = 5e-4;
/// Objects are not above the body.
const MOST_SIDE_RAD: f64 = std::f64::consts::FRAC_PI_2;
/// A dipole is no better than this share of an anomaly, even where nothing is seen to be left: a tenth of that of
/// one whose heave is not known.
const LEAST_MODEL_ERROR: f64 = 0.003;
/// Shares of a distance where another dipole may do as well, and how much alike the logarithms of distances of one and the same are.
const OTHER_DISTANCES: [f64; 4] = [0.4, 0.6, 1.6, 2.5];
const SAME_MODE: f64 = 0.1;
/// Within so many distances its anomaly is plain.
const MIDDLE: f64 = 1.5;
/// A fit that goes further than this from where it began, in distances or logarithms, is another object.
const FURTHEST: f64 = 1.5;

/// Multiples of this fill the unit interval evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Climbs from a place of the way and a distance to the largest likelihood, from the best of some sides. `range` bounds the
/// distance.
pub(super) fn climb(
    window: &Window<'_>,
    (at, distance): (f64, f64),
    sides_rad: &[f64],
    range: [f64; 2],
) -> Option<Fitted> {
    let is_bent = window.way.is_bent_at(at, distance);
    let (axes, sides_rad) = if is_bent { (3, sides_rad) } else { (2, &sides_rad[..1]) };
    let begun = sides_rad.iter().filter_map(|side_rad| window.at(at, distance, *side_rad));
    let mut best = begun.max_by(|a, b| a.glrt.total_cmp(&b.glrt))?;
    let mut steps = FIRST_STEPS;
    while steps[..axes].iter().copied().fold(0.0, f64::max) > LAST_STEP {
        let mut has_moved = [false; 3];
        for (axis, moved) in has_moved.iter_mut().enumerate().take(axes) {
            for sign in [1.0, -1.0] {
                let step = sign * steps[axis];
                let (own, ratio) = (best.dipole, if axis == 1 { step.exp() } else { 1.0 });
                let place = own.at + if axis == 0 { step * own.distance } else { 0.0 };
                let further = (own.distance * ratio).clamp(range[0], range[1]);
                let side_rad = own.side_rad + if axis == 2 { step } else { 0.0 };
                if (place - at).abs() > FURTHEST * distance
                    || (further / distance).ln().abs() > FURTHEST
                    || side_rad.abs() > MOST_SIDE_RAD
                {
                    continue;
                }
                if let Some(next) = window.at(place, further, side_rad).filter(|next| next.glrt > best.glrt) {
                    (best, *moved) = (next, true);
                    break;
                }
            }
        }
        (0..axes).for_each(|axis| steps[axis] *= if has_moved[axis] { 1.3 } else { 0.4 });
    }
    Some(best)
}

/// The best dipole, first, and others that are the best of all that are like them: of a nearer one and one further away, turned, the
/// anomalies may be alike.
pub(super) fn modes(window: &Window<'_>, best: Fitted, range: [f64; 2]) -> Vec<Fitted> {
    let Dipole { at, distance, side_rad, .. } = best.dipole;
    let others = OTHER_DISTANCES.into_iter().filter_map(|ratio| {
        let begun = (distance * ratio).clamp(range[0], range[1]);
        climb(window, (at, begun), &[side_rad], range)
    });
    let mut modes = vec![best];
    for other in others {
        let is_same = |mode: &Fitted| (other.dipole.distance / mode.dipole.distance).ln().abs() < SAME_MODE;
        if !modes.iter().any(is_same) {
            modes.push(other);
        }
    }
    modes.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    modes
}

/// What of an anomaly its dipole may not describe, as a share: what is left about its middle beyond noise, twice the standard
/// deviation of that included. Between a share that no dipole of a bent and heaving way is better than, and that of one where neither is known.
pub(super) fn model_error(window: &Window<'_>, fitted: &Fitted) -> f64 {
    let left = window.left(fitted);
    let is_middle = |k: &usize| (window.spot(*k).at - fitted.dipole.at).abs() < MIDDLE * fitted.dipole.distance;
    let middle: Vec<f64> = (0..left.len()).filter(is_middle).map(|k| left[k] * left[k]).collect();
    let count = middle.len() as f64;
    let beyond = middle.iter().sum::<f64>() - count + 2.0 * (2.0 * count).sqrt();
    (beyond.max(0.0) / fitted.glrt).sqrt().clamp(LEAST_MODEL_ERROR, MODEL_ERROR)
}

/// What one of the dipoles that are as likely differs from the best one by, in its columns ([`Dipole::columns`]). A fit takes as
/// much of the noise with it; what is left with this added has the power of the noise again. `index` tells one from another.
pub(super) fn deviation(window: &Window<'_>, dipole: &Dipole, index: usize) -> Option<[f64; 5]> {
    let columns = dipole.columns(window.way, &window.middles());
    let raw = DMatrix::from_fn(columns[0].len(), 5, |row, k| columns[k][row]);
    let white = window.whitened(raw);
    let products = white.tr_mul(&white);
    // The upper factor of the products, inverted, makes unit normals the deviations of their covariance.
    let upper = products.fixed_view::<5, 5>(0, 0).into_owned().cholesky()?.l().transpose();
    let normal = Normal::standard();
    let even = |k: usize| (0.5 + (5 * index + k + 1) as f64 * GOLDEN).fract();
    let normals = SVector::<f64, 5>::from_fn(|k, _| normal.inverse_cdf(even(k)));
    upper.solve_upper_triangular(&normals).map(Into::into)
}
