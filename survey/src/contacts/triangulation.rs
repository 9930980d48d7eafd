//! One dipole for several passes: where it must be, and of what moment, for all of them to have seen what they saw.
//!
//! Each pass tells five numbers ([`Told`]); an object has six, and those of its moment are linear. A single pass leaves one open, the
//! side where the object lies; a second one on another line tells it by its distance and, as a moment is the same from either side,
//! by its amplitudes.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::dipole::{NT_M3_PER_AM2, amplitudes_of_moment};
use super::posterior::{HEAVE_M, UNEVEN};
use super::told::{Numbers, Told};

/// What amplitudes are off by as a share of the largest: a pass is not straight, and no body heads exactly where it goes.
const AMPLITUDES: f64 = 0.1;
/// A body whose depth nobody recorded is higher or lower from pass to pass, m.
const UNKNOWN_DEPTH_M: f64 = 0.5;
/// Angles from straight down to abeam on either side, and distances between two standard deviations, that are tried first.
const ANGLES: i32 = 45;
const DISTANCES: i32 = 4;
/// Steps after that, m, halved down to the last.
const FIRST_STEP_M: f64 = 0.25;
const LAST_STEP_M: f64 = 0.01;

/// A pass, and where it was.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) told: &'a Told,
    /// Of the closest approach, m, east and north.
    pub(super) place_m: [f64; 2],
    /// Unit vector of the course, east and north.
    pub(super) course: [f64; 2],
    pub(super) altitude_m: Option<f64>,
}

impl View<'_> {
    /// Cosine of the angle between two courses.
    pub(super) fn along(&self, other: &View<'_>) -> f64 {
        self.course[0] * other.course[0] + self.course[1] * other.course[1]
    }

    /// From the closest approach to a place: ahead and to starboard, m.
    pub(super) fn ahead_starboard_m(&self, place_m: [f64; 2]) -> [f64; 2] {
        let ([east, north], [x, y]) = (self.course, [0, 1].map(|axis| place_m[axis] - self.place_m[axis]));
        [x * east + y * north, x * north - y * east]
    }

    /// The place so far ahead of the closest approach and to starboard of it, m, east and north.
    pub(super) fn place_at(&self, [ahead_m, starboard_m]: [f64; 2]) -> [f64; 2] {
        let ([east, north], [x, y]) = (self.course, self.place_m);
        [x + ahead_m * east + starboard_m * north, y + ahead_m * north - starboard_m * east]
    }
}

/// An object as it was seen from the first of some passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Object {
    /// Ahead of the closest approach, to starboard, and below the sensor, m.
    pub(super) ahead_m: f64,
    pub(super) starboard_m: f64,
    pub(super) below_m: f64,
    /// Sum of the squares of what the passes disagree by, over what they may.
    pub(super) squares: f64,
}

/// Where the object is if it lies to port, and to starboard, of the first pass. Positions of passes are off by `position_m`.
pub(super) fn either_side(views: &[View<'_>], position_m: f64) -> [Object; 2] {
    [-1.0, 1.0].map(|side| {
        let distance_m = views[0].told.mean[1].exp();
        let std = distance_std(views[0].told);
        let tries = (-DISTANCES..=DISTANCES).flat_map(|k| (0..=ANGLES).map(move |j| (k, j)));
        let of = |(k, j): (i32, i32)| {
            let angle = side * std::f64::consts::FRAC_PI_2 * f64::from(j) / f64::from(ANGLES);
            let distance_m = distance_m * (2.0 * std * f64::from(k) / f64::from(DISTANCES)).exp();
            object(views, [0.0, distance_m * angle.sin(), distance_m * angle.cos()], position_m)
        };
        let below = object(views, [0.0, 0.0, distance_m], position_m);
        let best = tries.map(of).fold(below, |best, next| if next.squares < best.squares { next } else { best });
        improved(views, best, side, position_m)
    })
}

fn improved(views: &[View<'_>], mut best: Object, side: f64, position_m: f64) -> Object {
    let mut step_m = FIRST_STEP_M;
    while step_m > LAST_STEP_M {
        let at = [best.ahead_m, best.starboard_m, best.below_m];
        let steps = (0..6).map(|k| {
            std::array::from_fn(|axis| {
                at[axis] + if axis == k / 2 { step_m * f64::from(2 * (k as i32 % 2) - 1) } else { 0.0 }
            })
        });
        let allowed = steps.filter(|[_, starboard_m, below_m]: &[f64; 3]| side * starboard_m >= 0.0 && *below_m >= 0.0);
        let next = allowed.map(|place| object(views, place, position_m)).min_by(|a, b| a.squares.total_cmp(&b.squares));
        match next.filter(|next| next.squares < best.squares) {
            Some(next) => best = next,
            None => step_m /= 2.0,
        }
    }
    best
}

/// The moment that fits best of an object at a place, seen from the first pass, and what is left then.
fn object(views: &[View<'_>], [ahead_m, starboard_m, below_m]: [f64; 3], position_m: f64) -> Object {
    let first = &views[0];
    let place_m = first.place_at([ahead_m, starboard_m]);
    let (mut gram, mut right, mut squares) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
    for view in views {
        let (off, of_moment, inverse) = residual(first, view, place_m, below_m, position_m);
        gram += of_moment.transpose() * inverse * of_moment;
        right += of_moment.transpose() * inverse * off;
        squares += off.dot(&(inverse * off));
    }
    let parts = gram.symmetric_eigen();
    let least = 1e-9 * parts.eigenvalues.max();
    let along = parts.eigenvectors.transpose() * right;
    let told: f64 =
        (0..3).filter(|&k| parts.eigenvalues[k] > least).map(|k| along[k].powi(2) / parts.eigenvalues[k]).sum();
    Object { ahead_m, starboard_m, below_m, squares: squares - told }
}

/// What a pass told less what of an object's place it should have; how its amplitudes go with the moment; the inverse covariance.
fn residual(
    first: &View<'_>,
    view: &View<'_>,
    place_m: [f64; 2],
    below_first_m: f64,
    position_m: f64,
) -> (Numbers, SMatrix<f64, 5, 3>, SMatrix<f64, 5, 5>) {
    let [east, north] = view.course;
    let [ahead_m, starboard_m] = view.ahead_starboard_m(place_m);
    let (below_m, below_std) = below(first, view, below_first_m);
    let distance_m = starboard_m.hypot(below_m).max(0.1);
    let axes = Matrix3::new(east, north, 0.0, north, -east, 0.0, 0.0, 0.0, 1.0);
    let toward = Vector3::new(0.0, starboard_m / distance_m, below_m / distance_m);
    let matrix = amplitudes_of_moment(toward, axes * view.told.field) * axes * (NT_M3_PER_AM2 / distance_m.powi(3));
    let mut of_moment = SMatrix::<f64, 5, 3>::zeros();
    of_moment.fixed_view_mut::<3, 3>(2, 0).copy_from(&matrix);
    let mut off = view.told.mean;
    // The pass is where its own closest approach is.
    off[0] = -ahead_m;
    off[1] -= distance_m.ln();
    let amplitude_nt = view.told.mean.fixed_rows::<3>(2).amax();
    let turned = AMPLITUDES.hypot(position_m.hypot(below_std) / distance_m) * amplitude_nt;
    let away = (position_m * starboard_m).hypot(below_std * below_m) / (distance_m * distance_m);
    let more =
        [position_m.powi(2), away.powi(2) + uneven(distance_m).powi(2), turned.powi(2), turned.powi(2), turned.powi(2)];
    let covariance = view.told.covariance + SMatrix::from_diagonal(&Numbers::from(more));
    (off, of_moment, covariance.try_inverse().unwrap_or_else(SMatrix::zeros))
}

/// How far below the sensor of a pass an object is, and what that may be off by, m. An object keeps its depth; the body does not.
fn below(first: &View<'_>, view: &View<'_>, below_first_m: f64) -> (f64, f64) {
    let by_depth = view.told.depth_m.zip(first.told.depth_m).map(|(own, first)| first - own);
    let by_altitude = view.altitude_m.zip(first.altitude_m).map(|(own, first)| own - first);
    match by_depth.or(by_altitude) {
        Some(higher_m) => (below_first_m + higher_m, 0.0),
        None => (below_first_m, UNKNOWN_DEPTH_M),
    }
}

/// Of the logarithm of the distance.
fn distance_std(told: &Told) -> f64 {
    told.covariance[(1, 1)].sqrt().hypot(uneven(told.mean[1].exp()))
}

fn uneven(distance_m: f64) -> f64 {
    UNEVEN.hypot(HEAVE_M / distance_m)
}
