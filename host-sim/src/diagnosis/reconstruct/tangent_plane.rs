//! Directions as two angles about a slow direction.
//!
//! The body's angles are band-limited; the components of a direction are products of their sines and cosines, and reach
//! higher frequencies. A low-pass over the components would cut these off, so it is the angles that are smoothed.

use crate::diagnosis::policy::SLOW_DIRECTION_ROWS;
use crate::diagnosis::reconstruct::smooth::slow;

/// A unit vector with two more across it, all slowly turning.
#[derive(Clone, Copy, Debug)]
struct Triad {
    along: [f64; 3],
    across: [[f64; 3]; 2],
}

/// Slow directions of a series, from which each direction is a rotation by two small angles.
pub(crate) struct TangentPlane {
    /// Slow directions, one a row, smooth.
    slow: [Vec<f64>; 3],
    /// The coordinate axis furthest from all slow directions: what "across" is measured from.
    pole: [f64; 3],
}

impl TangentPlane {
    /// Of vectors every 0.1 s; their magnitude does not matter.
    pub(crate) fn of(vectors: &[[f64; 3]]) -> Self {
        let units: Vec<[f64; 3]> = vectors.iter().map(|v| unit(*v)).collect();
        let slow = [0, 1, 2].map(|i| slow(&units.iter().map(|u| u[i]).collect::<Vec<_>>(), SLOW_DIRECTION_ROWS));
        let nearest = |pole: [f64; 3]| {
            (0..units.len()).map(|k| dot(unit([slow[0][k], slow[1][k], slow[2][k]]), pole).abs()).fold(0.0, f64::max)
        };
        let poles = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let pole = poles.into_iter().min_by(|a, b| nearest(*a).total_cmp(&nearest(*b))).unwrap_or(poles[2]);
        Self { slow, pole }
    }

    /// The slow direction's components, to be made dense by interpolation.
    pub(crate) fn slow(&self) -> &[Vec<f64>; 3] {
        &self.slow
    }

    /// The two angles of a vector about the slow direction, rad.
    pub(crate) fn angles(&self, row: usize, vector: [f64; 3]) -> [f64; 2] {
        let triad = self.triad([0, 1, 2].map(|i| self.slow[i][row]));
        let vector = unit(vector);
        let parts = triad.across.map(|across| dot(vector, across));
        let sine = parts[0].hypot(parts[1]);
        let angle = sine.atan2(dot(vector, triad.along));
        let scale = if sine > 1e-12 { angle / sine } else { 1.0 };
        parts.map(|part| part * scale)
    }

    /// The unit vector of two angles about a slow direction.
    pub(crate) fn direction(&self, slow: [f64; 3], angles: [f64; 2]) -> [f64; 3] {
        let triad = self.triad(slow);
        let angle = angles[0].hypot(angles[1]);
        let (sine, cosine) = angle.sin_cos();
        let scale = if angle > 1e-12 { sine / angle } else { 1.0 };
        unit([0, 1, 2].map(|i| {
            cosine * triad.along[i] + scale * (angles[0] * triad.across[0][i] + angles[1] * triad.across[1][i])
        }))
    }

    fn triad(&self, slow: [f64; 3]) -> Triad {
        let along = unit(slow);
        let first = unit(cross(along, self.pole));
        Triad { along, across: [first, cross(along, first)] }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Sixth difference of seven successive directions: a motion well below half of the rate has hardly any, white noise of
/// variance 1 has variance 924.
pub(crate) fn sixth_difference(near: &[[f64; 3]]) -> [f64; 3] {
    const WEIGHTS: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
    [0, 1, 2].map(|i| near.iter().zip(WEIGHTS).map(|(direction, weight)| weight * direction[i]).sum())
}

/// The vector over its length; the x axis for a vector without a length.
pub(crate) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = dot(vector, vector).sqrt();
    if length > 1e-300 { vector.map(|component| component / length) } else { [1.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_again() {
        let vectors: Vec<[f64; 3]> = (0..400)
            .map(|k| {
                let t = f64::from(k) * 0.1;
                [30_000.0 * (0.1 * t).cos(), 20_000.0 * (0.3 * t).sin() - 5_000.0, 40_000.0 + 3_000.0 * t.sin()]
            })
            .collect();
        let plane = TangentPlane::of(&vectors);
        for (row, vector) in vectors.iter().enumerate() {
            let slow = [0, 1, 2].map(|i| plane.slow()[i][row]);
            let back = plane.direction(slow, plane.angles(row, *vector));
            assert!(back.iter().zip(unit(*vector)).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
