//! Signals at 100 Hz, from which a reading at any instant is taken.

/// Samples a second.
pub(super) const FINE_HZ: f64 = 100.0;
/// Seconds before the first row and after the last: what a delayed or early reading reaches into.
const MARGIN_S: f64 = 10.0;
/// Samples from one row to the next.
const STRIDE: usize = 10;
/// Samples before the first row.
const BEFORE: usize = (MARGIN_S * FINE_HZ) as usize;

/// The instants of a recording: rows at 10 Hz, and 100 Hz around them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    rows: usize,
}

impl Grid {
    pub(super) fn new(rows: usize) -> Self {
        Self { rows }
    }

    /// Rows of the recording, before any is lost.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Time of a row since the first one, s.
    pub(super) fn row_s(row: usize) -> f64 {
        row as f64 * STRIDE as f64 / FINE_HZ
    }

    /// From the first row to the last, s.
    pub(super) fn duration_s(&self) -> f64 {
        Self::row_s(self.rows.saturating_sub(1))
    }

    /// Samples at 100 Hz.
    pub(super) fn len(&self) -> usize {
        self.rows.saturating_sub(1) * STRIDE + 1 + 2 * BEFORE
    }

    /// Times of all samples since the first row, s.
    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> + use<> {
        (0..self.len()).map(|index| (index as f64 - BEFORE as f64) / FINE_HZ)
    }

    /// Time of the first sample, s.
    pub(super) fn start_s(&self) -> f64 {
        -MARGIN_S
    }

    /// Time of the last sample, s.
    pub(super) fn end_s(&self) -> f64 {
        self.duration_s() + MARGIN_S
    }

    /// The sample of a row.
    pub(super) fn of_row(row: usize) -> usize {
        BEFORE + STRIDE * row
    }

    /// The samples at the rows.
    pub(super) fn at_rows<T: Copy>(&self, fine: &[T]) -> Vec<T> {
        (0..self.rows).map(|row| fine[Self::of_row(row)]).collect()
    }

    /// The value at an instant: six points around it, Lagrange.
    pub(super) fn at(&self, fine: &[f64], time_s: f64) -> f64 {
        let place = (time_s + MARGIN_S) * FINE_HZ;
        let middle = (place.floor() as isize).clamp(2, fine.len() as isize - 4);
        let x = place - middle as f64;
        (-2..=3)
            .map(|k| {
                let weight: f64 = (-2..=3).filter(|&j| j != k).map(|j| (x - f64::from(j)) / f64::from(k - j)).product();
                weight * fine[(middle + k as isize) as usize]
            })
            .sum()
    }

    /// Samples such that straight lines between them have the mean of the smooth course, to fourth order: straight lines cut its bends.
    fn bent_out(fine: &[f64]) -> Vec<f64> {
        let last = fine.len().saturating_sub(1);
        let bend = |k: usize| fine[k.saturating_sub(1)] - 2.0 * fine[k] + fine[(k + 1).min(last)];
        (0..fine.len()).map(|k| fine[k] - bend(k) / 12.0).collect()
    }

    /// Integral since the first sample, fourth order.
    pub(super) fn integral(fine: &[f64]) -> Vec<f64> {
        let fine = Self::bent_out(fine);
        let mut sum = 0.0;
        let mut last = fine.first().copied().unwrap_or(0.0);
        let mut add = |&value: &f64| {
            sum += 0.5 * (last + value) / FINE_HZ;
            last = value;
            sum
        };
        fine.iter().map(&mut add).collect()
    }

    /// Time derivative, fourth order.
    pub(super) fn derivative(fine: &[f64]) -> Vec<f64> {
        let last = fine.len() - 1;
        let at = |index: usize, off: isize| fine[(index as isize + off).clamp(0, last as isize) as usize];
        (0..fine.len()).map(|k| (at(k, -2) - 8.0 * at(k, -1) + 8.0 * at(k, 1) - at(k, 2)) * FINE_HZ / 12.0).collect()
    }

    /// First-order low-pass, fourth order. It starts in steady state, and again at each of `restarts`.
    pub(super) fn low_pass(fine: &[f64], time_constant_s: f64, restarts: &[usize]) -> Vec<f64> {
        let bent = Self::bent_out(fine);
        let ratio = 1.0 / (FINE_HZ * time_constant_s.max(1e-6));
        let keep = libm::exp(-ratio);
        // Weights of the two ends of the straight piece.
        let (early, late) = ((1.0 - keep) / ratio - keep, 1.0 - (1.0 - keep) / ratio);
        let (mut state, mut last) = (fine[0], bent[0]);
        let mut restarts = restarts.iter().peekable();
        let mut next = |(index, &value): (usize, &f64)| {
            state = keep * state + early * last + late * value;
            if restarts.next_if_eq(&&index).is_some() {
                state = fine[index];
            }
            last = value;
            state
        };
        bent.iter().enumerate().map(&mut next).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(grid: Grid, hz: f64) -> Vec<f64> {
        grid.times_s().map(|t| (std::f64::consts::TAU * hz * t).sin()).collect()
    }

    #[test]
    fn a_sine_is_read_differentiated_and_averaged_as_by_hand() {
        let (grid, omega) = (Grid::new(100), std::f64::consts::TAU * 1.2);
        let fine = sine(grid, 1.2);
        let (derivative, integral) = (Grid::derivative(&fine), Grid::integral(&fine));
        for t in [0.0, 1.2345, 7.777] {
            assert!((grid.at(&fine, t) - (omega * t).sin()).abs() < 1e-7);
            assert!((grid.at(&derivative, t) - omega * (omega * t).cos()).abs() < 1e-4 * omega);
            let mean = (grid.at(&integral, t) - grid.at(&integral, t - 0.3)) / 0.3;
            let exact = ((omega * (t - 0.3)).cos() - (omega * t).cos()) / (0.3 * omega);
            assert!((mean - exact).abs() < 1e-6, "{mean} {exact}");
        }
    }

    #[test]
    fn a_low_pass_has_the_gain_and_delay_of_its_time_constant() {
        let (grid, omega, tau) = (Grid::new(200), std::f64::consts::TAU * 0.5, 0.2);
        let filtered = Grid::low_pass(&sine(grid, 0.5), tau, &[]);
        let (gain, delay) = (1.0 / (1.0 + (omega * tau).powi(2)).sqrt(), (omega * tau).atan());
        for t in [5.0, 6.3, 11.1] {
            assert!((grid.at(&filtered, t) - gain * (omega * t - delay).sin()).abs() < 1e-6);
        }
    }
}
