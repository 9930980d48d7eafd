//! The best cone about evenly spread axes, by squares as if whitening left noise where it was.

use rayon::prelude::*;

use super::geometry::{Cone, HALF_ANGLE_STEP_DEG, cosine};
use crate::diagnosis::policy::{CONE_LEAST_SAMPLES, CONE_WIDEST_DEG};
use crate::diagnosis::search::axis::{axis, half_sphere};

/// Axes that are tried.
const AXES: usize = 300;

/// Squares of some samples: how many, and their sum.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Squares {
    pub(super) count: f64,
    pub(super) sum: f64,
}

impl Squares {
    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    pub(super) fn add(&mut self, square: f64) {
        *self = Self { count: self.count + 1.0, sum: self.sum + square };
    }
}

/// Twice the log likelihood ratio of a variance of their own for those inside; 0 unless it is the larger one.
pub(super) fn glrt_of_two(inside: Squares, outside: Squares) -> f64 {
    if inside.mean() <= outside.mean() {
        return 0.0;
    }
    let all = Squares { count: inside.count + outside.count, sum: inside.sum + outside.sum };
    all.count * all.mean().ln() - inside.count * inside.mean().ln() - outside.count * outside.mean().ln()
}

/// The best cone and its likelihood ratio, from squares and directions, one a sample each.
pub(super) fn best_of_axes(squares: &[f64], directions: &[[f64; 3]]) -> (f64, Cone) {
    let of_axis = |(azimuth_deg, elevation_deg)| {
        let axis = axis(azimuth_deg, elevation_deg);
        let (glrt, half_angle_deg) = best_angle(&by_angle(axis, squares, directions), squares);
        (glrt, Cone { axis, half_angle_deg })
    };
    let none = (0.0, Cone { axis: [1.0, 0.0, 0.0], half_angle_deg: HALF_ANGLE_STEP_DEG });
    let axes: Vec<(f64, f64)> = half_sphere(AXES).collect();
    let tried: Vec<(f64, Cone)> = axes.into_par_iter().map(of_axis).collect();
    tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(none)
}

/// Likelihood ratio and half angle, degrees, of the best cone about an axis.
fn best_angle(by_angle: &[Squares], squares: &[f64]) -> (f64, f64) {
    let (n, all) = (squares.len() as f64, squares.iter().sum::<f64>());
    let mut inside = Squares::default();
    let mut best = (0.0, HALF_ANGLE_STEP_DEG);
    for (bin, squares) in by_angle.iter().enumerate() {
        inside.count += squares.count;
        inside.sum += squares.sum;
        if inside.count < CONE_LEAST_SAMPLES || n - inside.count < CONE_LEAST_SAMPLES {
            continue;
        }
        let glrt = glrt_of_two(inside, Squares { count: n - inside.count, sum: all - inside.sum });
        if glrt > best.0 {
            best = (glrt, (bin + 1) as f64 * HALF_ANGLE_STEP_DEG);
        }
    }
    best
}

/// The squares by their angle to an axis, in steps of the half angle, as far as the widest cone goes.
fn by_angle(axis: [f64; 3], squares: &[f64], directions: &[[f64; 3]]) -> Vec<Squares> {
    let bins = (CONE_WIDEST_DEG / HALF_ANGLE_STEP_DEG) as usize;
    let mut histogram = vec![Squares::default(); bins];
    let outside = (CONE_WIDEST_DEG + HALF_ANGLE_STEP_DEG).to_radians().cos();
    let cosines = directions.iter().map(|&direction| cosine(axis, direction));
    // Most are outside, and need no angle.
    for (square, cosine) in squares.iter().zip(cosines).filter(|(_, cosine)| *cosine > outside) {
        let bin = (cosine.acos().to_degrees() / HALF_ANGLE_STEP_DEG) as usize;
        if let Some(squares) = histogram.get_mut(bin) {
            squares.add(*square);
        }
    }
    histogram
}
