//! Stretches of rows with a slow background of their own, which is also what is held out and drawn again.

use std::ops::Range;

use crate::diagnosis::reconstruct::reconstruction::BRIDGED_ROWS;

/// Seconds of a block for each term of its background, and terms more, because a polynomial over few periods follows the
/// slowest of them badly: takes what is below 0.02 Hz, passes what is above about 0.06 Hz.
const TERM_S: f64 = 10.0;
const MORE_TERMS: usize = 3;
/// Lengths that a block may have, s.
const LENGTHS_S: [f64; 2] = [25.0, 100.0];
/// Blocks that a recording should have at least, for parts of it to be held out.
const WANTED: f64 = 8.0;
/// Rows at each end of a stretch that are left out: there the direction is known from one side only.
const END_ROWS: usize = 10;
/// Shorter blocks are not worth their background, rows.
const LEAST_ROWS: usize = 60;
/// More missing rows than this share, and the block is left out.
const MOST_MISSING: f64 = 0.6;

/// Above this share of missing rows, blocks are short.
const MANY_MISSING: f64 = 0.08;

/// Successive rows of the recording.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Its rows.
    pub(crate) rows: Range<usize>,
    /// Which of them hold no reading, counted from its first.
    pub(crate) missing: Vec<usize>,
}

impl Block {
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The part of a column that is the block's, 0 where there is no reading.
    pub(crate) fn values(&self, column: &[f64]) -> Vec<f64> {
        let mut values = column[self.rows.clone()].to_vec();
        self.missing.iter().for_each(|&at| values[at] = 0.0);
        values
    }

    /// What is projected out: Legendre polynomials, and each missing row by itself.
    pub(crate) fn nuisance(&self) -> Vec<Vec<f64>> {
        let n = self.len();
        let terms = (n as f64 / 10.0 / TERM_S).round() as usize + MORE_TERMS;
        let x = |k: usize| 2.0 * k as f64 / (n - 1) as f64 - 1.0;
        let mut columns = vec![vec![1.0; n], (0..n).map(x).collect::<Vec<_>>()];
        for degree in 2..terms {
            let d = degree as f64;
            let next = (0..n)
                .map(|k| ((2.0 * d - 1.0) * x(k) * columns[degree - 1][k] - (d - 1.0) * columns[degree - 2][k]) / d);
            columns.push(next.collect());
        }
        for column in &mut columns {
            self.missing.iter().for_each(|&at| column[at] = 0.0);
        }
        columns.extend(self.missing.iter().map(|&at| (0..n).map(|k| f64::from(u8::from(k == at))).collect()));
        columns
    }
}

/// Cut usable rows into blocks, of even length within each stretch without a gap.
pub(crate) fn blocks(epochs_s: &[f64], usable: &[bool], longest_step_s: f64) -> Vec<Block> {
    let stretches = stretches(epochs_s, usable, longest_step_s);
    let rows: usize = stretches.iter().map(Range::len).sum();
    let wanted_s = (rows as f64 / 10.0 / WANTED).clamp(LENGTHS_S[0], LENGTHS_S[1]);
    let mut blocks = Vec::new();
    for stretch in stretches {
        let gone = stretch.clone().filter(|&row| !usable[row]).count() as f64;
        // Every missing row is a column of its own: many of them are cheaper in short blocks.
        let wanted_s = if gone > MANY_MISSING * stretch.len() as f64 { LENGTHS_S[0] } else { wanted_s };
        let parts = ((stretch.len() as f64 / 10.0 / wanted_s).round() as usize).max(1);
        for part in 0..parts {
            let at = |part: usize| stretch.start + stretch.len() * part / parts;
            let rows = at(part)..at(part + 1);
            let missing: Vec<usize> = (0..rows.len()).filter(|k| !usable[rows.start + k]).collect();
            if rows.len() >= LEAST_ROWS && missing.len() as f64 <= MOST_MISSING * rows.len() as f64 {
                blocks.push(Block { rows, missing });
            }
        }
    }
    blocks
}

/// Rows from a usable one to a usable one without a long pause between.
fn stretches(epochs_s: &[f64], usable: &[bool], longest_step_s: f64) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for row in (0..usable.len()).filter(|&row| usable[row]) {
        match stretches.last_mut() {
            Some(last)
                if row <= last.end + BRIDGED_ROWS
                    && epochs_s[last.end - 1..=row].windows(2).all(|pair| pair[1] - pair[0] <= longest_step_s) =>
            {
                last.end = row + 1;
            }
            _ => stretches.push(row..row + 1),
        }
    }
    let inner = |stretch: &Range<usize>| {
        stretch.start + END_ROWS..stretch.end.saturating_sub(END_ROWS).max(stretch.start + END_ROWS)
    };
    stretches.iter().map(inner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_part_blocks_and_missing_rows_do_not() {
        let mut epochs_s: Vec<f64> = (0..2000).map(|k| 0.1 * f64::from(k)).collect();
        epochs_s[1000..].iter_mut().for_each(|time_s| *time_s += 5.0);
        let mut usable = vec![true; 2000];
        usable[300..303].fill(false);
        let blocks = blocks(&epochs_s, &usable, 0.15);
        assert!(blocks.iter().all(|block| block.rows.end <= 1000 || block.rows.start >= 1000), "{blocks:?}");
        assert_eq!(blocks.iter().map(Block::len).sum::<usize>(), 2000 - 4 * END_ROWS);
        assert_eq!(blocks.iter().map(|block| block.missing.len()).sum::<usize>(), 3);
    }
}
