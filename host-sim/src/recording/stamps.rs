//! Stamps that jitter where the sampling does not: a sensor samples by a clock of its own, and the logger stamps the line of text when
//! it comes. A derivative by such stamps is wrong by a few per cent from row to row.

use std::ops::Range;

use super::rate::{EPOCH_S, LONGEST_STEP_S, TIME_ROUNDING_S};

/// Rows to either side of the line that even sampling is told by: 15 s, in which no clock wanders.
const HALF_ROWS: usize = 150;
/// Shorter stretches tell no line.
const LEAST_ROWS: usize = 20;
/// Stamps nearer to even ones than this stay, s: the most that a millisecond's rounding makes.
const LEAST_JITTER_S: f64 = 5e-4 + TIME_ROUNDING_S;
/// A value so many usual sizes off what its neighbours make of it, with the jitter and without, says nothing of its time.
const FAR_OFF: f64 = 10.0;
/// Of what the values differ from even sampling, the share that the stamps explain: 1 where they are the times of the values, 0 where
/// these are even. From here on they are.
const TRUE_SHARE: f64 = 0.5;

/// The even stamps of what was sampled evenly and stamped with a jitter, s; `None` where they are even as they are, or are the times at
/// which the values were taken. `channels` are what moves with the body, a value a row.
pub(super) fn evened(time_s: &[f64], channels: &[&[f64]]) -> Option<Vec<f64>> {
    let mut even_s = time_s.to_vec();
    for stretch in stretches(time_s).into_iter().filter(|stretch| stretch.len() >= LEAST_ROWS) {
        let stamps_s = &time_s[stretch.clone()];
        (0..stamps_s.len()).for_each(|row| even_s[stretch.start + row] = on_line(stamps_s, row));
    }
    let jitter_s: Vec<f64> = time_s.iter().zip(&even_s).map(|(stamp, even)| stamp - even).collect();
    let jitters = jitter_s.iter().any(|jitter| jitter.abs() > LEAST_JITTER_S);
    (jitters && explained_share(&jitter_s, channels) < TRUE_SHARE).then_some(even_s)
}

/// Rows whose times go on without a gap.
fn stretches(time_s: &[f64]) -> Vec<Range<usize>> {
    let goes_on = |step_s: f64| step_s > 0.0 && step_s <= LONGEST_STEP_S + TIME_ROUNDING_S;
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for row in (0..time_s.len()).filter(|&row| time_s[row].is_finite()) {
        match stretches.last_mut() {
            Some(last) if last.end == row && goes_on(time_s[row] - time_s[row - 1]) => last.end = row + 1,
            _ => stretches.push(row..row + 1),
        }
    }
    stretches
}

/// Where the line through the stamps about a row has it, by least squares.
fn on_line(stamps_s: &[f64], row: usize) -> f64 {
    let about = row.saturating_sub(HALF_ROWS)..(row + HALF_ROWS + 1).min(stamps_s.len());
    // From even stamps that begin at the row, so that nothing is lost to rounding.
    let off_s = |other: usize| stamps_s[other] - stamps_s[row] - EPOCH_S * (other as f64 - row as f64);
    let (count, middle) = (about.len() as f64, 0.5 * (about.start + about.end - 1) as f64);
    let mean_s = about.clone().map(off_s).sum::<f64>() / count;
    let [product, square] = about
        .map(|other| (other as f64 - middle, off_s(other)))
        .fold([0.0; 2], |[xy, xx], (x, y)| [xy + x * y, xx + x * x]);
    stamps_s[row] + mean_s + product / square * (row as f64 - middle)
}

/// How much of what values differ from those of their neighbours is what they change by in the jitter of their stamps: the slope of one
/// against the other, over all channels. 0 where nothing moves.
fn explained_share(jitter_s: &[f64], channels: &[&[f64]]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for values in channels {
        let rate = |row: usize| (values[row + 1] - values[row - 1]) / (2.0 * EPOCH_S);
        let moved = |row: usize| rate(row) * jitter_s[row];
        let pairs = (3..values.len().saturating_sub(3))
            .map(|row| (from_neighbours(row, |other| values[other]), from_neighbours(row, moved)));
        let pairs: Vec<(f64, f64)> = pairs.filter(|(off, moved)| off.is_finite() && moved.is_finite()).collect();
        let usual = usual_size(pairs.iter().map(|(off, _)| *off));
        let is_told = |(off, moved): &&(f64, f64)| off.abs().min((off - moved).abs()) <= FAR_OFF * usual;
        for (off, moved) in pairs.iter().filter(is_told) {
            product += off * moved;
            square += moved * moved;
        }
    }
    if square > 0.0 { product / square } else { 0.0 }
}

/// What a row has beyond the cubic through the two rows to either side.
fn from_neighbours(row: usize, of: impl Fn(usize) -> f64) -> f64 {
    of(row) - (4.0 * (of(row - 1) + of(row + 1)) - of(row - 2) - of(row + 2)) / 6.0
}

/// The median size; 0 of nothing.
fn usual_size(values: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = values.map(f64::abs).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that rocks, sampled at these times.
    fn rocking(time_s: &[f64]) -> Vec<f64> {
        let noise = |row: usize| (row * 7_919 % 1_009) as f64 / 1_009.0 - 0.5;
        time_s
            .iter()
            .enumerate()
            .map(|(row, s)| 3_000.0 * (0.9 * s).sin() + 400.0 * (2.7 * s).cos() + noise(row))
            .collect()
    }

    fn even(rows: usize) -> Vec<f64> {
        (0..rows).map(|row| 1.7e9 + 0.1 * row as f64 * (1.0 + 2e-4)).collect()
    }

    fn jittered(even_s: &[f64], most_s: f64) -> Vec<f64> {
        let jitter = |row: usize| 2.0 * ((row * 104_729 % 997) as f64 / 997.0 - 0.5);
        even_s.iter().enumerate().map(|(row, s)| s + most_s * jitter(row)).collect()
    }

    #[test]
    fn stamps_that_jitter_beside_even_samples_become_even_through_gaps() {
        let mut even_s = even(3_000);
        even_s[1_200..].iter_mut().for_each(|s| *s += 7.3);
        let values = rocking(&even_s);
        let evened = evened(&jittered(&even_s, 0.02), &[&values]).expect("they jitter");
        let worst_s = evened.iter().zip(&even_s).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst_s < 0.004, "{worst_s}");
        let worst_step_s = evened[..1_200].windows(2).map(|pair| (pair[1] - pair[0] - 0.1).abs()).fold(0.0, f64::max);
        assert!(worst_step_s < 4e-4, "{worst_step_s}");
    }

    #[test]
    fn times_at_which_the_values_were_taken_stay() {
        let time_s = jittered(&even(3_000), 0.02);
        assert_eq!(evened(&time_s, &[&rocking(&time_s)]), None);
    }

    #[test]
    fn even_stamps_stay_as_they_are_written() {
        let rounded: Vec<f64> = even(3_000).iter().map(|s| (1e3 * s).round() / 1e3).collect();
        assert_eq!(evened(&rounded, &[&rocking(&rounded)]), None);
        assert_eq!(evened(&[], &[&[]]), None);
        assert_eq!(evened(&[0.0, f64::NAN, 0.3], &[&[1.0, 2.0, 3.0]]), None);
    }
}
