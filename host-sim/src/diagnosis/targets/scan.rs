//! Where a residual may hold a dipole: a matched filter over all moments and distances.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use super::dipole::{Dipole, REACH_DISTANCES, profiles};
use super::residual::Residual;
use crate::diagnosis::noise::whitening::Whitening;
use crate::diagnosis::numerics::robust_mean_square;
use crate::diagnosis::policy::{
    RATE_HZ, TARGET_COARSE_GLRT, TARGET_DISTANCES_S, TARGET_LEAST_SHARE, TARGET_MOST_SPOTS,
};

/// Ratio of a distance to the next smaller one.
const DISTANCE_RATIO: f64 = 1.35;
/// Moments are this share of the distance apart.
const MOMENT_STEP: f64 = 0.25;
/// Moments nearer than this to a better one, in distances of both, are the same dipole.
const APART: f64 = 2.5;
/// What the best dipole near a spot may explain, over one just there.
const SPOT_TO_BEST: f64 = 2.0;
/// The noise about a moment is that from so many distances away on, over so many rows.
const BESIDE_DISTANCES: f64 = 2.5;
const BESIDE_ROWS: usize = 150;

/// A moment, and how far away a dipole would be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) row: usize,
    pub(super) distance_s: f64,
    /// What a dipole there explains, over the noise around it.
    pub(super) glrt: f64,
    /// The same over the noise of the whole residual.
    power: f64,
}

/// The spots where a dipole explains much more than the noise around it, apart from each other: first the one that explains
/// most, whose own flanks may be the noise around it, then the best.
pub(super) fn spots(residual: &Residual<'_>) -> Vec<Spot> {
    let ratio = |k: i32| TARGET_DISTANCES_S[0] * DISTANCE_RATIO.powi(k);
    let distances: Vec<f64> = (0..).map(ratio).take_while(|s| *s <= TARGET_DISTANCES_S[1]).collect();
    let adjoint = residual.adjoint();
    let predicted = Whitening::without_background(residual.whitening);
    let of_distance = |distance_s: &f64| at_distance(residual, &predicted, &adjoint, *distance_s);
    let mut all: Vec<Spot> = distances.par_iter().flat_map_iter(of_distance).collect();
    all.sort_by(|a, b| b.glrt.total_cmp(&a.glrt));
    if let Some(largest) = (0..all.len()).max_by(|&a, &b| all[a].power.total_cmp(&all[b].power)) {
        all[..=largest].rotate_right(1);
    }
    let mut spots: Vec<Spot> = Vec::new();
    for spot in all {
        let is_near = |other: &Spot| {
            spot.row.abs_diff(other.row) as f64 <= APART * RATE_HZ * (spot.distance_s + other.distance_s)
        };
        if !spots.iter().any(is_near) {
            spots.push(spot);
        }
        if spots.len() == TARGET_MOST_SPOTS {
            break;
        }
    }
    spots
}

/// All moments at one distance, as if whitening did everywhere what it does in the middle of the longest part of a block.
fn at_distance(residual: &Residual<'_>, predicted: &Whitening, adjoint: &[f64], distance_s: f64) -> Vec<Spot> {
    let distance_rows = distance_s * RATE_HZ;
    let half = (REACH_DISTANCES * distance_rows).ceil() as usize;
    let filter: Vec<[f64; 3]> = (0..=2 * half).map(|k| profiles((k as f64 - half as f64) / distance_rows)).collect();
    let gram = gram(residual, predicted, &filter, half);
    let Some(inverse) = gram.and_then(|gram| gram.try_inverse()) else { return Vec::new() };
    let step = ((MOMENT_STEP * distance_rows) as usize).max(1);
    let explained = |row: usize| {
        let first = row.saturating_sub(half);
        let last = (row + half).min(adjoint.len() - 1);
        let mut q = Vector3::zeros();
        for (value, profile) in adjoint[first..=last].iter().zip(&filter[first + half - row..]) {
            (0..3).for_each(|i| q[i] += value * profile[i]);
        }
        q.dot(&(inverse * q))
    };
    let rows = (0..adjoint.len()).step_by(step).map(|row| (row, explained(row))).collect::<Vec<_>>();
    let is_peak = |k: usize| (k.saturating_sub(1)..(k + 2).min(rows.len())).all(|other| rows[other].1 <= rows[k].1);
    let mut peaks: Vec<(usize, f64)> =
        (0..rows.len()).filter(|&k| rows[k].1 > TARGET_COARSE_GLRT && is_peak(k)).map(|k| rows[k]).collect();
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    // The background of a block takes more of a wide one in some places than in its middle.
    let exact = |(row, power): (usize, f64)| {
        let start = Dipole { epoch_s: residual.epochs_s[row], distance_s, amplitudes_nt: [0.0; 3] };
        let power = power.min(SPOT_TO_BEST * residual.judged(&start).glrt);
        Spot { row, distance_s, glrt: power / noise_beside(residual, row, distance_s), power }
    };
    let spots = peaks.into_iter().take(TARGET_MOST_SPOTS).map(exact);
    spots.filter(|spot| spot.glrt > TARGET_COARSE_GLRT).collect()
}

/// Products of the whitened profiles among each other, in the middle of the longest part of a block; none where the background takes
/// them almost whole: such a dipole is found at a smaller distance. `predicted` is the whitening without a background.
fn gram(residual: &Residual<'_>, predicted: &Whitening, filter: &[[f64; 3]], half: usize) -> Option<Matrix3<f64>> {
    let whitening = residual.whitening;
    let parts = whitening
        .blocks()
        .iter()
        .enumerate()
        .flat_map(|(k, block)| block.parts().into_iter().map(move |part| (k, part)));
    let (block, part) = parts.max_by_key(|(_, part)| part.len())?;
    let rows = whitening.blocks()[block].len();
    let at = |k: usize| (k + half).checked_sub(part.start + part.len() / 2).and_then(|k| filter.get(k));
    let column = |i: usize| (0..rows).map(|k| at(k).map_or(0.0, |profile| profile[i])).collect::<Vec<f64>>();
    let whitened = [0, 1, 2].map(|i| whitening.apply_block(block, &column(i)));
    let product = |i: usize, j: usize| whitened[i].iter().zip(&whitened[j]).map(|(a, b)| a * b).sum::<f64>();
    let gram = Matrix3::from_fn(product) / (residual.scale * residual.scale);
    let all: f64 = (0..3).map(|i| predicted.apply_block(block, &column(i)).iter().map(|x| x * x).sum::<f64>()).sum();
    (gram.trace() * residual.scale * residual.scale > TARGET_LEAST_SHARE * all).then_some(gram)
}

/// Mean square of the whitened residual about a moment, beside what a dipole there takes; never less than that of the noise.
pub(super) fn noise_beside(residual: &Residual<'_>, row: usize, distance_s: f64) -> f64 {
    let from = (BESIDE_DISTANCES * distance_s * RATE_HZ) as usize;
    let beside = |k: &usize| (from..from + BESIDE_ROWS).contains(&residual.row_of[*k].abs_diff(row));
    let values: Vec<f64> =
        residual.samples_near(row, from + BESIDE_ROWS).filter(beside).map(|k| residual.z[k]).collect();
    if values.len() < BESIDE_ROWS / 4 { 1.0 } else { robust_mean_square(&values).max(1.0) }
}
