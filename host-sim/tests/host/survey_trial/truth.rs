//! What is true of a made tow: when each dipole is passed, how far away, and how far it stands out of the noise.
//!
//! A pass is a row whose distance to the dipole is the smallest within 10 s to either side, and 30 m at most. Its signal is the change of the
//! size of the Earth's field along the body's way, from half the time to the pass before to half the time to the next. Its
//! signal to noise is that of the matched filter, `sqrt(sum_k |A_k|^2 / (N S_k))`, A the discrete Fourier transform of the
//! signal over its N rows, S the spectrum of a row, of
//!
//! - the scalar sensor's noise in its colour, and of the resolution that it rounds to;
//! - the rock along the track. Its sines have periods that are uniform in their logarithm and powers that go with them: over
//!   all draws that is a spectrum of `rms^2 / (19 P f^2)` from `1 / 20 P` to `1 / P`, P the shortest period, and none outside.
//!
//! What is slower than the slowest rock counts for nothing, for no recording tells the level. The body's own field and the
//! fluxgate's noise are left out: this is the bound of a survey that knows the body.

use host_sim::simulator::scenario::{Dipole, Simulation, Track};

use super::beside::Beside;
use super::spectrum::whitened;
use super::zero_phase::RATE_HZ;

/// Rows to either side among which a pass is the closest.
const ALONE: usize = 100;
/// From further away iron is neither seen nor in the way, m.
pub(crate) const FAR_M: f64 = 30.0;

/// Where a dipole is passed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pass {
    pub(crate) row: usize,
    pub(crate) time_s: f64,
    pub(crate) distance_m: f64,
}

/// A dipole, and its passes, each with its signal to noise.
#[derive(Clone, Debug)]
pub(crate) struct Iron {
    pub(crate) dipole: Dipole,
    pub(crate) passes: Vec<(Pass, f64)>,
    /// Share of the signal to noise, over all passes, that is left beside the 18 terms.
    pub(crate) beside: f64,
}

impl Iron {
    /// The pass that tells most, and its signal to noise.
    pub(crate) fn best_pass(&self) -> Option<(Pass, f64)> {
        self.passes.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Of the pass that tells most.
    pub(crate) fn snr(&self) -> f64 {
        self.best_pass().map_or(0.0, |(_, snr)| snr)
    }

    /// That of a survey that does not know the body.
    pub(crate) fn snr_beside(&self) -> f64 {
        self.snr() * self.beside
    }

    pub(crate) fn moment_am2(&self) -> f64 {
        length(self.dipole.moment_am2)
    }
}

/// Passes of a place, in order of time.
pub(crate) fn passes(track: &Track, place_m: &[f64; 3]) -> Vec<Pass> {
    let apart_m = |at: &[f64; 3]| length(std::array::from_fn(|i| at[i] - place_m[i]));
    let distance_m: Vec<f64> = track.place_m.iter().map(apart_m).collect();
    let last = distance_m.len() - 1;
    let is_pass = |&row: &usize| {
        let (first, end) = (row.saturating_sub(ALONE), (row + ALONE).min(last));
        let is_least =
            |other: usize| distance_m[row] < distance_m[other] || other >= row && distance_m[row] == distance_m[other];
        row > 0 && row < last && (first..=end).all(is_least)
    };
    let pass = |row: usize| {
        // Between rows: the square of the distance is a parabola in time.
        let square = |row: usize| distance_m[row] * distance_m[row];
        let (before, here, after) = (square(row - 1), square(row), square(row + 1));
        let bend = before - 2.0 * here + after;
        let shift = if bend > 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        let square_m2 = here - 0.25 * (before - after) * shift;
        Pass { row, time_s: (row as f64 + shift) / RATE_HZ, distance_m: square_m2.max(0.0).sqrt() }
    };
    (0..=last).filter(is_pass).map(pass).collect()
}

/// All iron of a tow.
pub(crate) fn iron(simulation: &Simulation) -> Vec<Iron> {
    let (track, scenario) = (simulation.track(), simulation.scenario());
    let body = Beside::new(simulation);
    let of = |dipole: &Dipole| {
        let passes = passes(track, &dipole.place_m);
        let bounds = |k: usize| {
            let first = if k == 0 { 0 } else { (passes[k - 1].row + passes[k].row) / 2 };
            let end = passes.get(k + 1).map_or(track.place_m.len(), |next| (passes[k].row + next.row) / 2);
            first..end
        };
        let snr = |k: usize| whitened(&anomaly_nt(simulation, dipole, bounds(k)), scenario).norm();
        let near = (0..passes.len()).filter(|&k| passes[k].distance_m <= FAR_M);
        let [alone, left] = body.snr(&anomaly_nt(simulation, dipole, 0..track.place_m.len()));
        Iron { dipole: *dipole, passes: near.map(|k| (passes[k], snr(k))).collect(), beside: left / alone }
    };
    track.dipoles.iter().map(of).collect()
}

/// What a dipole adds to the size of the Earth's field.
fn anomaly_nt(simulation: &Simulation, dipole: &Dipole, rows: std::ops::Range<usize>) -> Vec<f64> {
    let track = simulation.track();
    let earth_nt = simulation.scenario().field.strength_nt.unwrap_or(50_000.0);
    rows.map(|row| {
        let iron_nt = dipole.field_nt(track.place_m[row]);
        length(std::array::from_fn(|i| earth_nt * track.earth[i] + iron_nt[i])) - earth_nt
    })
    .collect()
}

pub(crate) fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_passes_once_where_the_dipole_is_abeam() {
        let place_m: Vec<[f64; 3]> = (0..2000).map(|k| [0.2 * f64::from(k), 0.0, 4.0]).collect();
        let mut track = Track::default();
        track.place_m = place_m;
        let found = passes(&track, &[100.05, 3.0, 8.0]);
        assert_eq!(found.len(), 1);
        assert!((found[0].time_s - 50.025).abs() < 1e-6 && (found[0].distance_m - 5.0).abs() < 1e-6, "{found:?}");
    }
}
