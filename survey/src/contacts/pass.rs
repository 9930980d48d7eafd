//! A contact as one pass saw it.

use std::ops::Range;

use nalgebra::Vector3;

use super::dipole::Dipole;
use super::levelled::{Levelled, RATE_HZ};
use super::posterior::{Posterior, Surroundings, posterior};
use super::search::Search;
use super::stretch::Stretch;
use super::told::Told;
use super::way::{Spot, Way};
use crate::result::Estimate;

/// A pass reaches so many distances to either side: the anomaly has less than a hundredth of its peak there.
const REACH: f64 = 6.0;
/// Contacts are as likely at every factor of what they explain up to this, over the threshold: a tenth to a hundred A m^2 at
/// 2 to 12 m span more.
const SPAN: f64 = 1e4;

/// A contact as one pass saw it.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Row of the closest approach.
    pub row: usize,
    /// Its time, s, between the rows.
    pub time_s: f64,
    /// Rows that it reaches.
    pub rows: Range<usize>,
    /// Way of these rows, m or s, as the dipole's.
    pub way: Vec<f64>,
    /// The fitted anomaly of these rows, nT.
    pub anomaly_nt: Vec<f64>,
    /// The best fit, in metres where the track is known, else in seconds.
    pub dipole: Dipole,
    /// Whether it is in metres.
    pub is_metres: bool,
    /// Largest of the anomaly by size, with its sign, nT.
    pub peak_nt: f64,
    /// Between the half heights of the largest lobe, s.
    pub width_s: f64,
    /// Matched, with the measured noise.
    pub snr: f64,
    /// That it is no target.
    pub false_alarm_probability: f64,
    /// Closest approach along the way, m or s.
    pub at: Estimate,
    /// Standard deviation of the closest approach along the way, m or s.
    pub at_std: f64,
    /// Closest distance, m or s.
    pub distance: Estimate,
    /// Magnetic moment, A m^2; `None` where the way is not in metres.
    pub moment_am2: Option<Estimate>,
    /// What it tells of an object that other passes saw too; `None` where the way is not in metres.
    pub told: Option<Told>,
}

/// `None` where it is no contact after all.
pub(super) fn pass(search: &Search<'_>, left: &[Stretch], index: usize) -> Option<Pass> {
    let (levelled, way) = (search.levelled(), &search.way);
    let (glrt, modes, window) = search.modes(left, index)?;
    let dipole = modes.first()?.dipole;
    let row = way.row_at(dipole.at);
    // A fit may leave the distances that are looked for: further away it is rock, nearer a few rows of noise.
    let (distance_s, [nearest_s, furthest_s]) = (dipole.distance / way.per_s[row], search.options.distances_s);
    if !(nearest_s..=furthest_s).contains(&distance_s) {
        return None;
    }
    let rows = way.rows_about(&dipole, REACH);
    let surroundings = way.is_metres.then(|| surroundings(levelled, row, distance_s));
    let Posterior { at, at_std, distance, moment_am2, told } = posterior(&window, &modes, surroundings.as_ref())?;
    let field = way.shape.as_ref().filter(|_| way.is_metres).map(|shape| shape.field);
    let told = told.zip(field).map(|((mean, covariance), field)| {
        let depth_m = surroundings.and_then(|surroundings| surroundings.depth_m);
        Told { mean, covariance, field, depth_m }
    });
    let (peak_nt, width) = largest_lobe(&dipole, way);
    Some(Pass {
        row,
        time_s: levelled.time_s[row] + (at.value - way.at[row]) / way.per_s[row],
        way: way.at[rows.clone()].to_vec(),
        anomaly_nt: dipole.anomaly_nt(way, &rows.clone().map(|row| way.spot_of_row(row)).collect::<Vec<_>>()),
        rows,
        dipole,
        is_metres: way.is_metres,
        peak_nt,
        width_s: width / way.per_s[row],
        snr: glrt.sqrt(),
        false_alarm_probability: false_alarm_probability(search, glrt),
        at,
        at_std,
        distance,
        moment_am2: way.is_metres.then_some(moment_am2),
        told,
    })
}

/// The largest value of an anomaly as it was passed, nT with its sign, and how wide that lobe is between its half heights, in the unit
/// of the way.
fn largest_lobe(dipole: &Dipole, way: &Way) -> (f64, f64) {
    const STEPS: i32 = 400;
    const SHARE: f64 = 0.01;
    let (first, last) = (way.at[0], way.at[way.at.len() - 1]);
    let places = (-2 * STEPS..=2 * STEPS).map(|step| dipole.at + f64::from(step) * SHARE * dipole.distance);
    let spots: Vec<Spot> = places.filter(|at| (first..=last).contains(at)).map(|at| way.spot(at)).collect();
    let values = dipole.anomaly_nt(way, &spots);
    let reach = f64::from(STEPS) * SHARE * dipole.distance;
    let near = (0..spots.len()).filter(|&k| (spots[k].at - dipole.at).abs() <= reach);
    let Some(peak) = near.max_by(|a, b| values[*a].abs().total_cmp(&values[*b].abs())) else { return (0.0, 0.0) };
    let nt = values[peak];
    let is_within = |value: &&f64| **value * nt.signum() >= 0.5 * nt.abs();
    let after = values[peak..].iter().take_while(is_within).count();
    let before = values[..=peak].iter().rev().take_while(is_within).count();
    (nt, (after + before - 1) as f64 * SHARE * dipole.distance)
}

/// Means over the rows of one distance to either side.
fn surroundings(levelled: &Levelled<'_>, row: usize, distance_s: f64) -> Surroundings {
    let half = (distance_s * RATE_HZ) as usize + 1;
    let near = row.saturating_sub(half)..(row + half + 1).min(levelled.time_s.len());
    let directions = levelled.direction.get(near.clone()).unwrap_or_default().iter().map(|d| Vector3::from(*d));
    let sum: Vector3<f64> = directions.filter(|d| d.iter().all(|x| x.is_finite())).sum();
    let mean = |column: Option<&[f64]>| {
        let near = column.map(|column| &column[near.clone()]).unwrap_or_default();
        let known: Vec<f64> = near.iter().copied().filter(|m| m.is_finite() && *m > 0.0).collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    };
    let (altitude_m, depth_m) = (mean(levelled.altitude_m), mean(levelled.depth_m));
    Surroundings { field: sum.try_normalize(0.0).unwrap_or_else(Vector3::z), altitude_m, depth_m }
}

/// Of all peaks that explain as much, the share that is noise: their density, from the null rate, against that of the contacts
/// found, as likely at every factor from the threshold on.
fn false_alarm_probability(search: &Search<'_>, glrt: f64) -> f64 {
    let step = 0.5;
    let false_ones = (search.null.inside_per_hour(glrt - step) - search.null.inside_per_hour(glrt + step))
        / (2.0 * step)
        * search.noise.hours();
    // One more than found: a recording with none so far may hold one.
    let true_ones = (search.found.len() + 1) as f64 / (SPAN.ln() * glrt);
    (false_ones / (false_ones + true_ones)).clamp(0.0, 1.0)
}
