//! Cones in both senses of their axis.

use crate::diagnosis::policy::CONE_WIDEST_DEG;
use crate::diagnosis::reconstruct::tangent_plane::{cross, unit};

/// Half angles that are told apart, degrees.
pub(super) const HALF_ANGLE_STEP_DEG: f64 = 0.5;

/// All directions within an angle of an axis or of its opposite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// Unit vector in body axes.
    pub(super) axis: [f64; 3],
    pub(super) half_angle_deg: f64,
}

impl Cone {
    /// Which directions it holds.
    pub(super) fn holds(&self, directions: &[[f64; 3]]) -> Vec<bool> {
        let least = self.half_angle_deg.to_radians().cos();
        directions.iter().map(|&direction| cosine(self.axis, direction) >= least).collect()
    }

    /// With its axis turned to two sides and its angle wider, all in degrees.
    pub(super) fn moved(&self, [side, other_side, wider]: [f64; 3]) -> Self {
        let [x, y, z] = self.axis;
        // A direction that is not the axis', to turn towards.
        let away = if z.abs() < 0.8 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let first = unit(cross(self.axis, away));
        let second = cross(self.axis, first);
        let (a, b) = (side.to_radians().tan(), other_side.to_radians().tan());
        let axis =
            [x + a * first[0] + b * second[0], y + a * first[1] + b * second[1], z + a * first[2] + b * second[2]];
        let half_angle_deg = (self.half_angle_deg + wider).clamp(HALF_ANGLE_STEP_DEG, CONE_WIDEST_DEG);
        Self { axis: unit(axis), half_angle_deg }
    }

    /// As a vector whose product with a direction is 1 on the cone's edge, more inside and less outside: cones that hold the same ones of
    /// some directions are convex sets of such vectors.
    pub(super) fn vector(&self) -> [f64; 3] {
        self.axis.map(|part| part / self.half_angle_deg.to_radians().cos())
    }

    /// The cone of such a vector; none where it would hold nothing, or be wider than the widest.
    pub(super) fn of_vector(vector: [f64; 3]) -> Option<Self> {
        let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
        let half_angle_deg = (1.0 / length).min(1.0).acos().to_degrees();
        let is_cone = (HALF_ANGLE_STEP_DEG..=CONE_WIDEST_DEG).contains(&half_angle_deg);
        is_cone.then(|| Self { axis: unit(vector), half_angle_deg })
    }

    /// Azimuth, elevation and half angle.
    pub(super) fn degrees(&self) -> [f64; 3] {
        let [x, y, z] = self.axis;
        [y.atan2(x).to_degrees(), z.clamp(-1.0, 1.0).asin().to_degrees(), self.half_angle_deg]
    }
}

/// Cosine of the angle to an axis in the nearer of its senses.
pub(super) fn cosine(axis: [f64; 3], direction: [f64; 3]) -> f64 {
    (0..3).map(|i| axis[i] * direction[i]).sum::<f64>().abs().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_holds_both_senses_of_its_axis_and_moves_by_the_degrees_asked_for() {
        let cone = Cone { axis: [0.0, 0.6, 0.8], half_angle_deg: 10.0 };
        assert_eq!(cone.holds(&[[0.0, 0.6, 0.8], [0.0, -0.6, -0.8], [1.0, 0.0, 0.0]]), [true, true, false]);
        let moved = cone.moved([3.0, 0.0, -4.0]);
        assert!((cosine(moved.axis, cone.axis).acos().to_degrees() - 3.0).abs() < 1e-9);
        assert_eq!(moved.half_angle_deg, 6.0);
    }

    #[test]
    fn a_cone_is_that_of_its_vector() {
        let cone = Cone { axis: [0.0, 0.6, 0.8], half_angle_deg: 12.0 };
        let again = Cone::of_vector(cone.vector()).unwrap();
        assert!((again.half_angle_deg - 12.0).abs() < 1e-9 && cosine(again.axis, cone.axis) > 1.0 - 1e-12);
        assert!(Cone::of_vector([0.0, 0.6, 0.8]).is_none());
    }
}
