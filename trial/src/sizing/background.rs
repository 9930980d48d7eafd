//! The slow background, and series without it.

/// Rows of a block.
const BLOCK_ROWS: usize = 1000;
/// Polynomials of a block: about half of a tone of 0.04 Hz is gone with them.
const POLYNOMIALS: usize = 12;

/// Polynomials of each block, orthonormal, with the row that they start at.
pub(super) fn basis(rows: usize) -> Vec<(usize, Vec<f64>)> {
    let blocks = (rows / BLOCK_ROWS).max(1);
    let mut all = Vec::new();
    for block in 0..blocks {
        let (start, end) = (block * rows / blocks, (block + 1) * rows / blocks);
        all.extend(polynomials(end - start).into_iter().map(|values| (start, values)));
    }
    all
}

/// A series less its background.
pub(crate) fn without_background(series: &[f64]) -> Vec<f64> {
    let mut rest = series.to_vec();
    for (start, values) in basis(series.len()) {
        let part = &mut rest[start..start + values.len()];
        let along: f64 = part.iter().zip(&values).map(|(a, b)| a * b).sum();
        part.iter_mut().zip(&values).for_each(|(value, polynomial)| *value -= along * polynomial);
    }
    rest
}

/// Root mean square.
pub(crate) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Legendre polynomials on a row of points: three terms, and made orthonormal on the points themselves.
fn polynomials(rows: usize) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = Vec::new();
    for degree in 0..POLYNOMIALS.min(rows) {
        let x = |row: usize| 2.0 * (row as f64 + 0.5) / rows as f64 - 1.0;
        let mut next: Vec<f64> = match all.last() {
            None => vec![1.0; rows],
            Some(last) => last.iter().enumerate().map(|(row, value)| x(row) * value).collect(),
        };
        for other in all.iter().skip(degree.saturating_sub(2)) {
            let along: f64 = next.iter().zip(other).map(|(a, b)| a * b).sum();
            next.iter_mut().zip(other).for_each(|(value, other)| *value -= along * other);
        }
        let length = next.iter().map(|value| value * value).sum::<f64>().sqrt();
        next.iter_mut().for_each(|value| *value /= length);
        all.push(next);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_background_ends_at_a_twenty_fifth_of_a_hertz() {
        let left = |hz: f64| {
            let tone: Vec<f64> =
                (0..6000).map(|row| (std::f64::consts::TAU * hz * f64::from(row) / 10.0 + 0.7).sin()).collect();
            rms(&without_background(&tone)) / rms(&tone)
        };
        assert!(left(0.01) < 1e-3 && left(0.1) > 0.85, "{} {}", left(0.01), left(0.1));
        assert!((0.3..0.85).contains(&left(0.04)), "{}", left(0.04));
    }
}
