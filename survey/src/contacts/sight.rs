//! What a dipole adds to the field where the way bends: the profiles of a straight pass, and what the bend makes of them.

use nalgebra::{Matrix3, RowVector3, Vector3};

use super::dipole::{Dipole, amplitudes_of_moment, profiles};
use super::way::{Spot, Way};

/// The way is straight if, within so many distances, it is no further beside its direction than this share of the distance: there
/// the profiles have a thirtieth of their peaks and less.
const ABOUT: f64 = 3.0;
const STRAIGHT: f64 = 0.1;
/// The bend counts in full to so many distances, which is what a fit sees, and not at all from so many on: the way may come back,
/// and on which side of it the dipole is may not be known.
const IN_FULL: f64 = 5.0;
const NOT_AT_ALL: f64 = 8.0;
/// A way that comes nearer than this share of the distance, at one of so many places to either side, is not the way of a pass: the
/// shape is not known so well.
const LEAST_DISTANCE: f64 = 0.5;
const BESIDE: i32 = 6;
/// Moments that would show so little on a straight pass, against those that show most, are held for none.
const LEAST_SHOWN: f64 = 0.2;

/// A dipole as it is seen from the way.
pub(super) struct Sight {
    dipole: Dipole,
    bent: Option<Bent>,
}

/// What a bend needs.
struct Bent {
    closest: Vector3<f64>,
    /// Rotates into (forward, starboard, down) at the closest approach.
    axes: Matrix3<f64>,
    toward: Vector3<f64>,
    field: Vector3<f64>,
    /// Moments of the amplitudes.
    moments: Matrix3<f64>,
}

impl Sight {
    pub(super) fn of(way: &Way, dipole: &Dipole) -> Self {
        let bent = way.is_bent_at(dipole.at, dipole.distance).then(|| Bent::of(way, dipole)).flatten();
        Self { dipole: *dipole, bent }
    }

    /// The three profiles at a spot, of 1 nT.
    pub(super) fn profiles(&self, spot: &Spot) -> [f64; 3] {
        let u = (spot.at - self.dipole.at) / self.dipole.distance;
        let straight = profiles(u);
        let Some(bent) = self.bent.as_ref().filter(|_| u.abs() < NOT_AT_ALL) else { return straight };
        let change = bent.change(spot, u, self.dipole.distance);
        let share = ((NOT_AT_ALL - u.abs()) / (NOT_AT_ALL - IN_FULL)).min(1.0);
        std::array::from_fn(|k| straight[k] + share * change[k])
    }
}

impl Bent {
    fn of(way: &Way, dipole: &Dipole) -> Option<Self> {
        let shape = way.shape.as_ref()?;
        let [forward, starboard] = shape.axes(way.row_at(dipole.at));
        let axes = Matrix3::from_rows(&[forward.transpose(), starboard.transpose(), Vector3::z().transpose()]);
        let (sin, cos) = dipole.side_rad.sin_cos();
        let (toward, field) = (Vector3::new(0.0, sin, cos), axes * shape.field);
        let closest = way.spot(dipole.at).place;
        let dipole_m = closest + axes.transpose() * toward * dipole.distance;
        let is_by = |share: f64| {
            let spot = way.spot(dipole.at + share * ABOUT * dipole.distance);
            (spot.place - dipole_m).norm() < LEAST_DISTANCE * dipole.distance
        };
        if (-BESIDE..=BESIDE).any(|k| is_by(f64::from(k) / f64::from(BESIDE))) {
            return None;
        }
        Some(Self { closest, axes, toward, field, moments: moments(amplitudes_of_moment(toward, field))? })
    }

    /// What the bend adds to the profiles.
    fn change(&self, spot: &Spot, u: f64, distance: f64) -> RowVector3<f64> {
        let place = self.axes * (spot.place - self.closest) / distance;
        let [bent, straight] = [place, Vector3::new(u, 0.0, 0.0)].map(|place| self.of_moments(place - self.toward));
        (bent - straight) * self.moments
    }

    /// The anomaly of moments of 1 in each direction, seen from so far, in distances, off the dipole.
    fn of_moments(&self, from: Vector3<f64>) -> RowVector3<f64> {
        let square = from.norm_squared();
        let cube = square * square.sqrt();
        (3.0 * from.dot(&self.field) / square * from - self.field).transpose() / cube
    }
}

/// The inverse of the amplitudes of moments, those that hardly show left out.
fn moments(amplitudes: Matrix3<f64>) -> Option<Matrix3<f64>> {
    let parts = amplitudes.svd(true, true);
    let least = LEAST_SHOWN * parts.singular_values.max();
    let inverted = parts.singular_values.map(|value| value / (value * value + least * least));
    Some(parts.v_t?.transpose() * Matrix3::from_diagonal(&inverted) * parts.u?.transpose())
}

impl Way {
    /// Whether the way bends about a place, for a dipole so far away.
    pub(super) fn is_bent_at(&self, at: f64, distance: f64) -> bool {
        let Some(shape) = &self.shape else { return false };
        let [forward, _] = shape.axes(self.row_at(at));
        let closest = self.spot(at).place;
        [-1.0, -0.5, 0.5, 1.0].into_iter().any(|share| {
            let off = share * ABOUT * distance;
            (self.spot(at + off).place - closest - forward * off).norm() > STRAIGHT * distance
        })
    }
}
