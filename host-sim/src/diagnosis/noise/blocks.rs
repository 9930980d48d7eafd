//! Blocks: stretches of rows with a slow background of their own. They are also the unit that cross-validation holds out
//! and the bootstrap draws.

use std::ops::Range;

use crate::diagnosis::policy::{
    BACKGROUND_EXTRA_TERMS, BACKGROUND_TERM_S, BLOCK_LEAST_ROWS, BLOCK_LENGTHS_S, BLOCK_MOST_MISSING, BLOCKS_WANTED,
    BRIDGED_ROWS, LONG_RUN_ROWS, RATE_HZ, SHORT_BLOCK_MISSING, STRETCH_END_ROWS,
};

/// Successive rows of the recording.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Its rows.
    pub(crate) rows: Range<usize>,
    /// Which of them hold no reading, counted from its first.
    pub(crate) missing: Vec<usize>,
    /// What is fitted of targets in it and near it: columns of as many values as it has rows.
    pub(crate) targets: Vec<Vec<f64>>,
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

    /// Stretches of its rows, counted from its first, that are whitened each by itself: a long run of missing rows parts them, as what
    /// lies before it says next to nothing of the noise behind it. Those rows are in none.
    pub(crate) fn parts(&self) -> Vec<Range<usize>> {
        let (mut parts, mut start) = (Vec::new(), 0);
        for run in self.runs().filter(|run| is_long(run)) {
            parts.push(start..run[0]);
            start = run[run.len() - 1] + 1;
        }
        parts.push(start..self.len());
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// Its rows that are in no part, counted from its first.
    pub(crate) fn between_parts(&self) -> impl Iterator<Item = usize> {
        self.runs().filter(|run| is_long(run)).flatten().copied()
    }

    /// Missing rows within the parts.
    fn bridged(&self) -> impl Iterator<Item = usize> {
        self.runs().filter(|run| !is_long(run)).flatten().copied()
    }

    /// Missing rows that follow each other.
    fn runs(&self) -> impl Iterator<Item = &[usize]> {
        self.missing.chunk_by(|a, b| a + 1 == *b)
    }

    /// Columns that are projected out of the block: Legendre polynomials for the background, what is fitted of targets, and
    /// one unit impulse for each missing row of the parts. As many values each as the block has rows; all others are 0 at missing rows.
    pub(crate) fn nuisance(&self) -> Vec<Vec<f64>> {
        let n = self.len();
        let terms = (n as f64 / RATE_HZ / BACKGROUND_TERM_S).round() as usize + BACKGROUND_EXTRA_TERMS;
        let mut columns = legendre(n, terms);
        columns.extend(self.targets.iter().cloned());
        for column in &mut columns {
            self.missing.iter().for_each(|&at| column[at] = 0.0);
        }
        columns.extend(self.bridged().map(|at| (0..n).map(|k| f64::from(u8::from(k == at))).collect()));
        columns
    }
}

fn is_long(run: &[usize]) -> bool {
    run.len() >= LONG_RUN_ROWS
}

/// The first `terms` Legendre polynomials (at least two) at `n` points from -1 to 1, by Bonnet's recursion.
fn legendre(n: usize, terms: usize) -> Vec<Vec<f64>> {
    let x = |k: usize| 2.0 * k as f64 / (n - 1) as f64 - 1.0;
    let mut columns = vec![vec![1.0; n], (0..n).map(x).collect::<Vec<_>>()];
    for degree in 2..terms {
        let d = degree as f64;
        let next =
            (0..n).map(|k| ((2.0 * d - 1.0) * x(k) * columns[degree - 1][k] - (d - 1.0) * columns[degree - 2][k]) / d);
        columns.push(next.collect());
    }
    columns
}

/// Cut usable rows into blocks, of even length within each stretch without a gap. Rows further apart than
/// `longest_step_s` are on two sides of a gap.
pub(crate) fn blocks(epochs_s: &[f64], usable: &[bool], longest_step_s: f64) -> Vec<Block> {
    let stretches = stretches(epochs_s, usable, longest_step_s);
    let rows: usize = stretches.iter().map(Range::len).sum();
    let length_s = (rows as f64 / RATE_HZ / BLOCKS_WANTED).clamp(BLOCK_LENGTHS_S[0], BLOCK_LENGTHS_S[1]);
    stretches.iter().flat_map(|stretch| cut(stretch, usable, length_s)).collect()
}

/// Blocks of about `length_s` of one stretch; those with too few rows or readings are left out.
fn cut(stretch: &Range<usize>, usable: &[bool], length_s: f64) -> impl Iterator<Item = Block> {
    let missing: Vec<usize> = (0..stretch.len()).filter(|k| !usable[stretch.start + k]).collect();
    let bridged = Block { rows: stretch.clone(), missing, targets: Vec::new() }.bridged().count() as f64;
    // Every missing row of a part is a nuisance column of its own: many of them cost less in short blocks.
    let length_s = if bridged > SHORT_BLOCK_MISSING * stretch.len() as f64 { BLOCK_LENGTHS_S[0] } else { length_s };
    let parts = ((stretch.len() as f64 / RATE_HZ / length_s).round() as usize).max(1);
    let start_of = move |part: usize| stretch.start + stretch.len() * part / parts;
    (0..parts).filter_map(move |part| {
        let rows = start_of(part)..start_of(part + 1);
        let missing: Vec<usize> = (0..rows.len()).filter(|k| !usable[rows.start + k]).collect();
        let is_enough =
            rows.len() >= BLOCK_LEAST_ROWS && missing.len() as f64 <= BLOCK_MOST_MISSING * rows.len() as f64;
        is_enough.then_some(Block { rows, missing, targets: Vec::new() })
    })
}

/// Stretches of rows without a gap, each from a usable row to a usable row, without the rows at their ends.
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
        stretch.start + STRETCH_END_ROWS
            ..stretch.end.saturating_sub(STRETCH_END_ROWS).max(stretch.start + STRETCH_END_ROWS)
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
        assert_eq!(blocks.iter().map(Block::len).sum::<usize>(), 2000 - 4 * STRETCH_END_ROWS);
        assert_eq!(blocks.iter().map(|block| block.missing.len()).sum::<usize>(), 3);
    }

    #[test]
    fn a_long_run_of_missing_rows_parts_a_block_and_has_no_columns() {
        let missing: Vec<usize> = (40..42).chain(100..100 + LONG_RUN_ROWS).collect();
        let block = Block { rows: 1000..1300, missing, targets: Vec::new() };
        assert_eq!(block.parts(), [0..100, 100 + LONG_RUN_ROWS..300]);
        assert_eq!(block.between_parts().collect::<Vec<_>>(), (100..100 + LONG_RUN_ROWS).collect::<Vec<_>>());
        let background = Block { missing: Vec::new(), ..block.clone() }.nuisance().len();
        assert_eq!(block.nuisance().len(), background + 2);
    }
}
