//! By how much the clock of a simulation is ahead of the recording's. By the fluxgate: effects that make a reading late are
//! the scalar sensor's, and are not to be taken for an offset.

use nalgebra::{DMatrix, DVector};
use towmag_fourier::{Complex, Planner};

use super::SimulatedTrack;
use crate::diagnosis::numerics::{cumulative_sums, golden_section_minimum};
use crate::diagnosis::policy::RATE_HZ;
use crate::diagnosis::reconstruct::prepared::Prepared;
use crate::error::HostError;

/// Seconds that recording and simulation must share.
const LEAST_SHARED_S: f64 = 60.0;
/// Share of the fluxgate's changes that a simulation of the same track explains at least, by any linear map of its vector. Far below
/// what the simulator's own scenarios give with every effect of the fluxgate in the recording (0.98), far above what two tows have in
/// common.
const LEAST_EXPLAINED: f64 = 0.8;
/// About the best whole tenth of a second, s, and the finest step of the search, s: a fiftieth of what an offset may be off.
const SEARCHED_S: f64 = 0.1;
const FINEST_S: f64 = 1e-4;

/// The offset of a simulation's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::diagnosis) struct Alignment {
    /// Its clock less the recording's, s: what the recording has at `t` it has at `t` + offset.
    pub(in crate::diagnosis) offset_s: f64,
    /// Share of the changes of the recording's fluxgate that it explains there.
    pub(in crate::diagnosis) explained: f64,
}

/// Lay a simulation on a recording.
///
/// # Errors
///
/// When the two do not share a track for a minute.
pub(super) fn align(table: &Prepared, track: &SimulatedTrack) -> Result<Alignment, HostError> {
    let none = || {
        HostError::NotEnough(format!(
            "{}: the fluxgate of this simulation follows that of {} nowhere for {LEAST_SHARED_S:.0} s; it must be of the same track",
            track.file, table.file
        ))
    };
    let coarse_s = coarse_s(table, track).ok_or_else(none)?;
    let step_s = track.step_s();
    let explained = |offset_s: f64| explained(table, track, offset_s, step_s);
    let about_s = [coarse_s - SEARCHED_S, coarse_s + SEARCHED_S];
    let offset_s = golden_section_minimum(|offset_s| -explained(offset_s), about_s, FINEST_S);
    let found = Alignment { offset_s, explained: explained(offset_s) };
    (found.explained >= LEAST_EXPLAINED).then_some(found).ok_or_else(none)
}

/// The best whole tenth of a second, by the cross-correlation of the vectors' changes from one tenth to the next.
fn coarse_s(table: &Prepared, track: &SimulatedTrack) -> Option<f64> {
    let step_s = track.step_s();
    let own = |time_s: f64| track.place(time_s, step_s).map(|place| place.of_vectors(&track.flux_nt));
    let (first_s, last_s) = (*track.time_s.first()?, *track.time_s.last()?);
    let count = ((last_s - first_s) * RATE_HZ).floor() as usize + 1;
    let simulated = changes((0..count).map(|k| own(first_s + k as f64 / RATE_HZ)));
    let start_s = *table.time_s.first()?;
    let rows = ((table.time_s.last()? - start_s) * RATE_HZ).round() as usize + 1;
    let mut recorded = vec![None; rows];
    for (time_s, flux) in table.time_s.iter().zip(&table.flux_nt) {
        recorded[(((time_s - start_s) * RATE_HZ).round() as usize).min(rows - 1)] = Some(*flux);
    }
    let recorded = changes(recorded.into_iter());
    let shift = best_shift(&recorded, &simulated)?;
    Some(first_s - start_s + shift as f64 / RATE_HZ)
}

/// Changes from one row to the next; none beside a hole.
fn changes(vectors: impl Iterator<Item = Option<[f64; 3]>>) -> Vec<[f64; 3]> {
    let all: Vec<Option<[f64; 3]>> = vectors.map(|v| v.filter(|v| v.iter().all(|nt| nt.is_finite()))).collect();
    let change = |pair: &[Option<[f64; 3]>]| match (pair[0], pair[1]) {
        (Some(a), Some(b)) => std::array::from_fn(|i| b[i] - a[i]),
        _ => [0.0; 3],
    };
    all.windows(2).map(change).collect()
}

/// The row of the second with which the first begins, for the highest correlation over what both have.
fn best_shift(first: &[[f64; 3]], second: &[[f64; 3]]) -> Option<isize> {
    let size = (first.len() + second.len()).next_power_of_two();
    let mut product = vec![Complex::new(0.0, 0.0); size];
    let mut planner = Planner::new();
    let (forward, inverse) = (planner.forward(size), planner.inverse(size));
    for i in 0..3 {
        let [mut a, mut b] = [first, second].map(|vectors| {
            let mut padded: Vec<Complex<f64>> = vectors.iter().map(|v| Complex::new(v[i], 0.0)).collect();
            padded.resize(size, Complex::new(0.0, 0.0));
            padded
        });
        forward.process(&mut a);
        forward.process(&mut b);
        product.iter_mut().zip(a.iter().zip(&b)).for_each(|(sum, (a, b))| *sum += a.conj() * b);
    }
    inverse.process(&mut product);
    let power_of = |v: &[f64; 3]| v.iter().map(|nt| nt * nt).sum::<f64>();
    let [powers_first, powers_second] = [first, second].map(|vectors| cumulative_sums(vectors.iter().map(power_of)));
    let least = (LEAST_SHARED_S * RATE_HZ) as isize;
    let (n, m) = (first.len() as isize, second.len() as isize);
    let correlation = |shift: isize| {
        let (from, to) = (0.max(-shift), n.min(m - shift));
        let power = |sums: &[f64], from: isize, to: isize| sums[to as usize] - sums[from as usize];
        let scale = power(&powers_first, from, to) * power(&powers_second, from + shift, to + shift);
        let at = product[shift.rem_euclid(size as isize) as usize].re / size as f64;
        if scale > 0.0 { at / scale.sqrt() } else { 0.0 }
    };
    let shared = (least - n..=m - least).filter(|&shift| n.min(m - shift) - 0.max(-shift) >= least);
    shared.map(|shift| (shift, correlation(shift))).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(shift, _)| shift)
}

/// Share of the changes of the recording's vector that the simulation's explains at an offset, by the best linear map.
fn explained(table: &Prepared, track: &SimulatedTrack, offset_s: f64, step_s: f64) -> f64 {
    let (mut gram, mut cross, mut sums) = (DMatrix::<f64>::zeros(4, 4), DMatrix::<f64>::zeros(4, 3), [[0.0; 2]; 3]);
    let mut rows = 0.0;
    for (time_s, flux) in table.time_s.iter().zip(&table.flux_nt).filter(|(_, flux)| flux[0].is_finite()) {
        let Some(place) = track.place(time_s + offset_s, step_s) else { continue };
        let own = place.of_vectors(&track.flux_nt);
        let regressors = DVector::from_column_slice(&[1.0, own[0] / 1e4, own[1] / 1e4, own[2] / 1e4]);
        let reading = DVector::from_column_slice(&flux.map(|nt| nt / 1e4));
        gram += &regressors * regressors.transpose();
        cross += &regressors * reading.transpose();
        sums.iter_mut()
            .zip(reading.iter())
            .for_each(|([sum, squares], nt)| (*sum, *squares) = (*sum + nt, *squares + nt * nt));
        rows += 1.0;
    }
    if rows < LEAST_SHARED_S * RATE_HZ {
        return 0.0;
    }
    // A body that hardly turns leaves the map open, and what it explains as it is.
    let Ok(map) = gram.svd(true, true).solve(&cross, 1e-12) else { return 0.0 };
    let fitted: f64 = (0..3).map(|i| cross.column(i).dot(&map.column(i)) - sums[i][0] * sums[i][0] / rows).sum();
    let all: f64 = sums.iter().map(|[sum, squares]| squares - sum * sum / rows).sum();
    if all > 0.0 { fitted / all } else { 0.0 }
}
