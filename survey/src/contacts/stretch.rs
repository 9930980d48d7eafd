//! Stretches of a recording on an even grid of times.

use super::levelled::{Levelled, RATE_HZ};

/// Holes up to this many rows are bridged by a line; a longer one ends a stretch.
const LONGEST_HOLE: usize = 50;
/// Shorter stretches hold no contact: less than three distances of the shortest on either side, and no noise to measure, rows.
const LEAST_ROWS: usize = 300;

/// A stretch on an even grid of times.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// Row of the recording of every cell; `None` in a hole.
    pub(super) rows: Vec<Option<usize>>,
    /// Field, nT; in a hole on a line between its ends.
    pub(super) values: Vec<f64>,
}

impl Stretch {
    /// Row nearest to a cell.
    pub(super) fn row_near(&self, cell: usize) -> usize {
        let off = (0..self.rows.len()).find_map(|off| {
            let before = cell.checked_sub(off).and_then(|k| self.rows.get(k).copied().flatten());
            before.or_else(|| self.rows.get(cell + off).copied().flatten())
        });
        off.unwrap_or(0)
    }

    /// First cell at or after a row, if the row is within.
    pub(super) fn cell_near(&self, row: usize) -> Option<usize> {
        let is_within = self.rows.iter().flatten().next().is_some_and(|first| *first <= row);
        (0..self.rows.len()).find(|&k| self.rows[k].is_some_and(|own| own >= row)).filter(|_| is_within)
    }

    /// The same with other values, a row of the recording each; one that is not finite makes a hole.
    pub(super) fn with(&self, values: &[f64]) -> Self {
        let mut own: Vec<f64> = self.rows.iter().map(|row| row.map_or(f64::NAN, |row| values[row])).collect();
        let rows = self.rows.iter().zip(&own).map(|(row, value)| row.filter(|_| value.is_finite())).collect();
        bridge(&mut own);
        Self { rows, values: own }
    }
}

/// The stretches of the rows that count.
pub(super) fn stretches(levelled: &Levelled<'_>) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut last_s = f64::NEG_INFINITY;
    for row in 0..levelled.time_s.len() {
        let time_s = levelled.time_s[row];
        if !(levelled.is_valid[row] && levelled.field_nt[row].is_finite() && time_s > last_s) {
            continue;
        }
        let steps = ((time_s - last_s) * RATE_HZ).round();
        match stretches.last_mut() {
            Some(stretch) if steps <= LONGEST_HOLE as f64 => {
                stretch.rows.extend((1..(steps as usize).max(1)).map(|_| None));
                stretch.rows.push(Some(row));
            }
            _ => stretches.push(Stretch { rows: vec![Some(row)], values: Vec::new() }),
        }
        last_s = time_s;
    }
    stretches.retain(|stretch| stretch.rows.len() >= LEAST_ROWS);
    stretches.iter().map(|stretch| stretch.with(levelled.field_nt)).collect()
}

/// Puts what is missing on a line between its ends; both ends are there.
fn bridge(values: &mut [f64]) {
    let known: Vec<usize> = (0..values.len()).filter(|&k| values[k].is_finite()).collect();
    for pair in known.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
        let (from, to) = (values[pair[0]], values[pair[1]]);
        let span = (pair[1] - pair[0]) as f64;
        (pair[0] + 1..pair[1]).for_each(|k| values[k] = from + (to - from) * (k - pair[0]) as f64 / span);
    }
    let (Some(&first), Some(&last)) = (known.first(), known.last()) else { return values.fill(0.0) };
    let (head, tail) = (values[first], values[last]);
    values[..first].fill(head);
    values[last + 1..].fill(tail);
}
