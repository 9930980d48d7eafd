//! Where a dipole is about the way, and how its anomaly goes with its moment.

use nalgebra::{Matrix3, RowVector3, Vector3};

use super::dipole::{Dipole, amplitudes_of_moment};
use super::way::{Spot, Way};

/// The shape of the way is looked at within so many distances: there the profiles have a thirtieth of their peaks and less.
pub(super) const ABOUT: f64 = 3.0;
/// The bend counts in full to so many distances, which is what a fit sees, and not at all from so many on: the way may come back,
/// and on which side of it the dipole is may not be known. Of positions the way is known further.
const FADES: [f64; 2] = [5.0, 8.0];
const FADES_OF_TRACK: [f64; 2] = [10.0, 15.0];
/// A way that comes nearer than this share of the distance, at one of so many places to either side, is not the way of a pass: the
/// shape is not known so well.
const LEAST_DISTANCE: f64 = 0.5;
const BESIDE: i32 = 6;
/// Moments that would show so little on a straight pass, against those that show most, are held for none.
const LEAST_SHOWN: f64 = 0.2;

/// A dipole about the way, and what its amplitudes are the moments of.
pub(super) struct Geometry {
    at: f64,
    distance: f64,
    closest: Vector3<f64>,
    /// Rotates into (forward, starboard, down) at the closest approach.
    axes: Matrix3<f64>,
    toward: Vector3<f64>,
    /// Unit vector of the Earth's field in those axes.
    pub(super) field: Vector3<f64>,
    /// Moments of the amplitudes.
    pub(super) moments: Matrix3<f64>,
    /// To how many distances the bend counts in full, and from where on not at all.
    fades: [f64; 2],
    is_straight: bool,
}

impl Geometry {
    /// `None` where nothing tells the shape of the way.
    pub(super) fn of(way: &Way, dipole: &Dipole) -> Option<Self> {
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
        Some(Self {
            at: dipole.at,
            distance: dipole.distance,
            closest,
            axes,
            toward,
            field,
            moments: moments(amplitudes_of_moment(toward, field))?,
            fades: if shape.is_track { FADES_OF_TRACK } else { FADES },
            is_straight: (-BESIDE..=BESIDE).any(|k| is_by(f64::from(k) / f64::from(BESIDE))),
        })
    }

    /// Share of the bend that counts.
    fn share(&self, u: f64) -> f64 {
        let [in_full, not_at_all] = self.fades;
        if self.is_straight { 0.0 } else { ((not_at_all - u.abs()) / (not_at_all - in_full)).clamp(0.0, 1.0) }
    }

    /// From the closest approach to a spot on a straight way and on this one, in distances; and the share of the bend.
    fn on(&self, spot: &Spot) -> ([Vector3<f64>; 2], f64) {
        let u = (spot.at - self.at) / self.distance;
        let bent = self.axes * (spot.place - self.closest) / self.distance;
        ([Vector3::new(u, 0.0, 0.0), bent], self.share(u))
    }

    /// From the dipole to a spot, in distances.
    pub(super) fn off_dipole(&self, spot: &Spot) -> Vector3<f64> {
        let ([straight, bent], share) = self.on(spot);
        straight.lerp(&bent, share) - self.toward
    }

    /// What the bend adds to the profiles; `None` where the way is taken to be straight.
    pub(super) fn bend(&self, spot: &Spot) -> Option<RowVector3<f64>> {
        let (ways, share) = self.on(spot);
        if share == 0.0 {
            return None;
        }
        let [straight, bent] = ways.map(|place| self.of_moments(place - self.toward));
        Some(share * ((bent - straight) * self.moments))
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
    let inverted = parts.singular_values.map(|value| value / value.max(least).powi(2));
    Some(parts.v_t?.transpose() * Matrix3::from_diagonal(&inverted) * parts.u?.transpose())
}
