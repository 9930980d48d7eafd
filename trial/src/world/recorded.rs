//! A recording as a world: what was read, as a signal between its rows, for effects that need no other physics.

use super::body::Body;
use super::columns::Columns;
use super::grid::Grid;
use super::motion::Motion;
use super::noise::Noise;
use super::state::{World, rate};
use super::vector::{Vector, length, scaled};

/// Rows that an instant between two rows is made of, either side.
const REACH: isize = 16;
/// Where the Earth's field points, for targets: a recording does not tell. North, east, down; inclined by 65 degrees.
const EARTH: Vector = [0.422_618_26, 0.0, 0.906_307_79];

impl World {
    /// What was recorded, to be disturbed: scalar and fluxgate at each row of the 10 Hz grid, nT, where they were read.
    /// Its noise is to be set to what the recording leaves of the 18 terms.
    pub(crate) fn of_recording(first_time_s: f64, readings_nt: &[Option<[f64; 4]>]) -> Self {
        let grid = Grid::new(readings_nt.len());
        let [scalar_nt, x, y, z] = std::array::from_fn(|k| {
            let known = readings_nt.iter().map(|reading| reading.map_or(f64::NAN, |reading| reading[k]));
            fine(&grid, &bridged(known.collect()))
        });
        let there: Vec<bool> = readings_nt.iter().map(Option::is_some).collect();
        let flux: Vec<Vector> = (0..grid.len()).map(|at| [x[at], y[at], z[at]]).collect();
        let field_nt: Vec<f64> = flux.iter().map(|&f| length(f)).collect();
        let direction: Vec<Vector> = flux.iter().zip(&field_nt).map(|(&f, nt)| scaled(f, 1.0 / nt)).collect();
        Self {
            grid,
            motion: Motion::still(),
            body: Body { permanent_nt: [0.0; 3], induced: [[0.0; 3]; 3], eddy_s: [[0.0; 3]; 3] },
            columns: Columns::none(first_time_s, &there),
            earth: EARTH,
            rate: rate(&direction),
            direction,
            field_nt,
            scalar_nt,
            eddy_nt: Vec::new(),
            noise: Noise::white(1.0),
            flux_noise_nt: 1.0,
            is_noisy: true,
        }
    }
}

/// Straight lines across holes.
fn bridged(mut values: Vec<f64>) -> Vec<f64> {
    let known: Vec<usize> = (0..values.len()).filter(|&at| values[at].is_finite()).collect();
    let Some((&first, &last)) = known.first().zip(known.last()) else { return vec![0.0; values.len()] };
    let (start, end) = (values[first], values[last]);
    values[..first].fill(start);
    values[last..].fill(end);
    for pair in known.windows(2) {
        let (from, to) = (values[pair[0]], values[pair[1]]);
        let span = (pair[1] - pair[0]) as f64;
        (pair[0] + 1..pair[1]).for_each(|at| values[at] = from + (to - from) * (at - pair[0]) as f64 / span);
    }
    values
}

/// At 100 Hz: a windowed sinc, which keeps the noise as loud as it is; the first and last value go on.
fn fine(grid: &Grid, rows: &[f64]) -> Vec<f64> {
    let middle = rows.first().copied().unwrap_or(0.0);
    let at = |row: isize| rows[row.clamp(0, rows.len() as isize - 1) as usize] - middle;
    let kernel: Vec<Vec<f64>> = (0..10_i32)
        .map(|step| (1 - REACH..=REACH).map(|k| lanczos(k as f64 - f64::from(step) / 10.0)).collect())
        .collect();
    let value = |t: f64| {
        let tenths = (100.0 * t).round() as isize;
        let (row, step) = (tenths.div_euclid(10), tenths.rem_euclid(10) as usize);
        let sum: f64 = (1 - REACH..=REACH).zip(&kernel[step]).map(|(k, weight)| weight * at(row + k)).sum();
        middle + sum
    };
    grid.times_s().map(value).collect()
}

fn lanczos(x: f64) -> f64 {
    use std::f64::consts::PI;
    let sinc = |x: f64| if x.abs() < 1e-12 { 1.0 } else { libm::sin(PI * x) / (PI * x) };
    if x.abs() >= REACH as f64 { 0.0 } else { sinc(x) * sinc(x / REACH as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stay_as_they_are_and_a_tone_is_right_between_them() {
        let grid = Grid::new(400);
        let tone = |t: f64| 100.0 + (std::f64::consts::TAU * 3.0 * t).sin();
        let rows: Vec<f64> = (0..400).map(|row| tone(0.1 * f64::from(row))).collect();
        let fine = fine(&grid, &rows);
        assert!(grid.at_rows(&fine).iter().zip(&rows).all(|(a, b)| (a - b).abs() < 1e-9));
        for (value, t) in fine.iter().zip(grid.times_s()).filter(|(_, t)| (5.0..35.0).contains(t)) {
            assert!((value - tone(t)).abs() < 0.01, "{t} {value}");
        }
    }

    #[test]
    fn holes_are_bridged() {
        let nan = f64::NAN;
        assert_eq!(bridged(vec![nan, 1.0, nan, 3.0, nan]), [1.0, 1.0, 2.0, 3.0, 3.0]);
    }
}
