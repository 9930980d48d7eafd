//! A dense uniform time grid: values between its points, derivatives, and filters in continuous time.

/// Uniform points in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Points per second.
    pub rate_hz: f64,
    /// Time of the first point, s.
    pub start_s: f64,
    /// How many points.
    pub len: usize,
}

impl Grid {
    /// Time of the last point, s.
    pub fn end_s(&self) -> f64 {
        self.start_s + (self.len.max(1) - 1) as f64 / self.rate_hz
    }

    /// Time of a point, s.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / self.rate_hz
    }

    /// The point nearest to a time.
    pub fn nearest(&self, time_s: f64) -> usize {
        (((time_s - self.start_s) * self.rate_hz).round() as usize).min(self.len - 1)
    }

    /// Where a time lies: the first of the four points around it, and how the four weigh (cubic Lagrange).
    ///
    /// At 100 Hz, a sine of 1 Hz is met to 4e-7 of its amplitude.
    pub fn cell(&self, time_s: f64) -> (usize, [f64; 4]) {
        debug_assert!(self.len >= 4);
        let position = (time_s - self.start_s) * self.rate_hz;
        let first = (position.floor() - 1.0).clamp(0.0, (self.len - 4) as f64);
        // Outside the grid the value at its edge holds: nothing is known there.
        let x = (position - first).clamp(0.0, 3.0);
        (first as usize, lagrange(x))
    }

    /// The value at any time.
    pub fn at(&self, values: &[f64], time_s: f64) -> f64 {
        let (first, weights) = self.cell(time_s);
        let four = &values[first..first + 4];
        weights[0] * four[0] + weights[1] * four[1] + weights[2] * four[2] + weights[3] * four[3]
    }

    /// The vector at any time.
    pub fn vector_at(&self, values: &[[f64; 3]], time_s: f64) -> [f64; 3] {
        let (first, weights) = self.cell(time_s);
        let four = &values[first..first + 4];
        std::array::from_fn(|i| (0..4).map(|k| weights[k] * four[k][i]).sum())
    }

    /// Time derivative at every point: central differences of fourth order, a millionth off at 1 Hz and 100 Hz.
    pub fn derivative(&self, values: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let last = values.len() - 1;
        (0..values.len())
            .map(|k| {
                let at = k.clamp(2, last - 2);
                let inner = |i: usize| {
                    (8.0 * (values[at + 1][i] - values[at - 1][i]) - (values[at + 2][i] - values[at - 2][i])) / 12.0
                };
                std::array::from_fn(|i| inner(i) * self.rate_hz)
            })
            .collect()
    }

    /// First-order low-pass in continuous time, `tau y' = x - y`, over the points `span`, in steady state at its first.
    ///
    /// Each cell is integrated exactly for the cubic through the four points around it: a piecewise linear input
    /// would pass for a window of a cell's length.
    pub fn low_pass(&self, values: &[f64], time_constant_s: f64, span: std::ops::Range<usize>) -> Vec<f64> {
        let step = 1.0 / (self.rate_hz * time_constant_s);
        let weights = cell_weights(step);
        let keep = libm::exp(-step);
        let mut out = Vec::with_capacity(span.len());
        let mut y = values[span.start];
        for k in span.clone() {
            if k > span.start {
                // The four points around the cell from k - 1 to k, of which the edges lack one.
                let four = [k.saturating_sub(2).max(span.start), k - 1, k, (k + 1).min(span.end - 1)];
                y *= keep;
                for (weight, index) in weights.iter().zip(four) {
                    y += weight * values[index];
                }
            }
            out.push(y);
        }
        out
    }
}

/// Cubic Lagrange weights of the points 0, 1, 2, 3 at `x`.
fn lagrange(x: f64) -> [f64; 4] {
    let (a, b, c, d) = (x, x - 1.0, x - 2.0, x - 3.0);
    [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0]
}

/// What the four points around a cell add over it: the integral of `exp(-(1 - v) step) step` times their Lagrange
/// polynomials, v from 0 to 1 across the cell.
fn cell_weights(step: f64) -> [f64; 4] {
    // The kernel is narrow when the time constant is short: pieces of at most half of it.
    let pieces = (2.0 * step).ceil().clamp(1.0, 64.0) as usize;
    let mut weights = [0.0; 4];
    for piece in 0..pieces {
        for (node, weight) in GAUSS_LEGENDRE {
            let v = (piece as f64 + 0.5 + 0.5 * node) / pieces as f64;
            let kernel = step * libm::exp(-(1.0 - v) * step) * 0.5 * weight / pieces as f64;
            for (sum, polynomial) in weights.iter_mut().zip(lagrange(1.0 + v)) {
                *sum += kernel * polynomial;
            }
        }
    }
    weights
}

/// Nodes in -1 to 1 and weights of the Gauss-Legendre rule with 8 points.
pub(crate) const GAUSS_LEGENDRE: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const GRID: Grid = Grid { rate_hz: 100.0, start_s: -5.0, len: 3001 };

    fn sine(grid: &Grid, frequency_hz: f64) -> Vec<f64> {
        (0..grid.len).map(|k| (TAU * frequency_hz * grid.time_s(k)).sin()).collect()
    }

    #[test]
    fn between_the_points_a_sine_stays_a_sine() {
        let values = sine(&GRID, 1.0);
        for k in 0..1000 {
            let time_s = 0.0137 * f64::from(k);
            assert!((GRID.at(&values, time_s) - (TAU * time_s).sin()).abs() < 5e-7);
        }
        assert_eq!(GRID.at(&values, 1e9), values[3000]);
    }

    #[test]
    fn the_derivative_of_a_sine_is_a_cosine() {
        let values: Vec<_> = sine(&GRID, 1.0).into_iter().map(|x| [x, 0.0, 0.0]).collect();
        for (k, rate) in GRID.derivative(&values).iter().enumerate().skip(2).take(2900) {
            assert!((rate[0] - TAU * (TAU * GRID.time_s(k)).cos()).abs() < 1e-5);
        }
    }

    #[test]
    fn the_low_pass_has_its_analytic_response() {
        for time_constant_s in [0.002, 0.02, 0.2] {
            let values = sine(&GRID, 1.0);
            let passed = GRID.low_pass(&values, time_constant_s, 0..GRID.len);
            let wt = TAU * time_constant_s;
            for (k, y) in passed.iter().enumerate().skip(1000).take(1900) {
                let phase = TAU * GRID.time_s(k) - wt.atan();
                assert!((y - phase.sin() / (1.0 + wt * wt).sqrt()).abs() < 1e-6, "{time_constant_s} {k}");
            }
        }
    }
}
