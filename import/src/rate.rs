//! The rate of the rows: which it is, and stamps made regular.

use crate::rows::is_quantised;
use crate::statistics::median_step;
/// A recording's own rate, Hz.
pub(crate) use towmag::RATE_HZ;

/// The share by which the median step may be off.
pub(crate) const RATE_TOLERANCE: f64 = 0.05;
/// Stamps off the even ones by less are even, s.
const JITTER_S: f64 = 5e-4;
/// Even stamps off tenths of a second by less become tenths, s.
const NICE_S: f64 = 0.02;
/// The shortest step that a recording may have, s; longer ones than three of it are gaps, which stay.
const SHORTEST_STEP_S: f64 = 0.05;

/// Stretches of rows without a gap, and the step between their rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sampling {
    /// Usual time from one row to the next, s.
    pub step_s: f64,
    /// Rows of each stretch.
    pub stretches: Vec<std::ops::Range<usize>>,
}

impl Sampling {
    /// Of times that do not go back; `None` for fewer than two.
    pub(crate) fn of(times: &[f64]) -> Option<Self> {
        let quantum = if is_quantised(times) { Some(median_step(times)?) } else { None };
        Self::with_quantum(times, quantum)
    }

    fn with_quantum(times: &[f64], quantum: Option<f64>) -> Option<Self> {
        let step_s = match quantum {
            // The rows of a stamp that is not the first nor the last, counted.
            Some(quantum) => quantum / rows_a_stamp(times)?,
            None => median_step(times)?,
        };
        let longest_s = quantum.unwrap_or(0.0) * 1.01 + step_s * 1.5;
        let mut begin = 0;
        let mut stretches = Vec::new();
        for row in 1..times.len() {
            if times[row] - times[row - 1] > longest_s {
                stretches.push(begin..row);
                begin = row;
            }
        }
        stretches.push(begin..times.len());
        // Over whole stretches, so that neither jitter nor coarse stamps count.
        let (span_s, steps) = stretches.iter().fold((0.0, 0), |(span_s, steps), stretch| {
            (span_s + times[stretch.end - 1] - times[stretch.start], steps + stretch.len() - 1)
        });
        let mean_s = if quantum.is_none() && steps > 20 { span_s / steps as f64 } else { step_s };
        Some(Self { step_s: mean_s, stretches })
    }

    /// Rows a second.
    pub(crate) fn rate_hz(&self) -> f64 {
        1.0 / self.step_s
    }
}

/// How many rows share a stamp, the mean over the stamps that are whole: three now and four then are 3.3.
fn rows_a_stamp(times: &[f64]) -> Option<f64> {
    let mut counts: Vec<usize> = times.chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
    if counts.len() > 2 {
        counts.remove(0);
        counts.pop();
    }
    let (sum, len) = (counts.iter().sum::<usize>(), counts.len());
    (len > 0).then(|| sum as f64 / len as f64)
}

/// Whether times can stay as they are in a recording of 10 Hz.
pub(crate) fn is_regular(times: &[f64]) -> bool {
    times.windows(2).all(|pair| pair[1] - pair[0] >= SHORTEST_STEP_S)
}

/// The stamps of a regular sampler, made regular: a line through those of each stretch. Stamps that no line fits stay.
pub(crate) fn regular(times: &[f64], sampling: &Sampling) -> (Vec<f64>, bool) {
    let mut regular = times.to_vec();
    let mut changed = false;
    for stretch in &sampling.stretches {
        let stamps = &times[stretch.clone()];
        if stamps.len() < 3 {
            continue;
        }
        let (begin, step_s) = line(stamps);
        let farthest = stamps.iter().enumerate().map(|(at, stamp)| (stamp - begin - step_s * at as f64).abs());
        let farthest_s = farthest.fold(0.0, f64::max);
        let quantum_s = if is_quantised(stamps) { step_s * rows_a_stamp(stamps).unwrap_or(1.0) } else { 0.0 };
        if farthest_s > JITTER_S && farthest_s <= (quantum_s * 1.1).max(1.5 * sampling.step_s) {
            changed = true;
            // Clocks cut stamps off, they do not round: the line lies half of what is cut too low.
            let shift_s = if quantum_s > 0.0 { (quantum_s - step_s) / 2.0 } else { 0.0 };
            let (begin, step_s) = nice(begin + shift_s, step_s, stamps.len());
            for (at, time) in regular[stretch.clone()].iter_mut().enumerate() {
                *time = begin + step_s * at as f64;
            }
        }
    }
    (regular, changed)
}

/// Tenths of a second, where the line runs along them.
fn nice(begin: f64, step_s: f64, len: usize) -> (f64, f64) {
    let tenth = (begin * RATE_HZ).round() / RATE_HZ;
    let end_off_s = begin + step_s * (len - 1) as f64 - tenth - (len - 1) as f64 / RATE_HZ;
    let is_nice = (begin - tenth).abs() < NICE_S && end_off_s.abs() < NICE_S;
    if is_nice { (tenth, 1.0 / RATE_HZ) } else { (begin, step_s) }
}

/// Begin and step of the line through evenly numbered values, by least squares.
fn line(stamps: &[f64]) -> (f64, f64) {
    let (len, first) = (stamps.len() as f64, stamps[0]);
    let middle = (len - 1.0) / 2.0;
    let mean = stamps.iter().map(|stamp| stamp - first).sum::<f64>() / len;
    let (mut upper, mut lower) = (0.0, 0.0);
    for (at, stamp) in stamps.iter().enumerate() {
        let from_middle = at as f64 - middle;
        upper += from_middle * (stamp - first - mean);
        lower += from_middle * from_middle;
    }
    let step_s = upper / lower;
    (first + mean - step_s * middle, step_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_clean_jittered_and_coarse_stamps() {
        let clean: Vec<f64> = (0..500).map(|row| f64::from(row) * 0.05).collect();
        assert!((Sampling::of(&clean).unwrap().rate_hz() - 20.0).abs() < 1e-9);
        let jittered: Vec<f64> = (0..500).map(|row| f64::from(row) * 0.1 + f64::from(row * 7 % 5) * 0.004).collect();
        let sampling = Sampling::of(&jittered).unwrap();
        assert!((sampling.rate_hz() - 10.0).abs() < 0.01 && sampling.stretches.len() == 1);
        let coarse: Vec<f64> = (0..500).map(|row| (f64::from(row) * 0.1).floor()).collect();
        let sampling = Sampling::of(&coarse).unwrap();
        assert!((sampling.rate_hz() - 10.0).abs() < 1e-9 && sampling.stretches.len() == 1);
        let (even, changed) = regular(&coarse, &sampling);
        assert!(changed && even.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-3));
        assert!(even[0].abs() < 1e-9, "{}", even[0]);
    }

    #[test]
    fn gaps_part_stretches() {
        let times: Vec<f64> = (0..100).map(|row| f64::from(row) * 0.1 + if row >= 40 { 3.0 } else { 0.0 }).collect();
        let sampling = Sampling::of(&times).unwrap();
        assert_eq!(sampling.stretches, [0..40, 40..100]);
        assert!(is_regular(&times) && !regular(&times, &sampling).1);
    }
}
