//! Readings that do not move.

use towmag_recording::Column;

use super::statistics::moments;
use crate::draft::Draft;
use crate::finding::Finding;
use crate::source::FindingKind;

/// Equal readings in a row that no moving body gives: 10 s.
const ROWS: usize = 100;
/// The body moves when another reading varies by this much meanwhile, nT.
const MOVES_NT: f64 = 20.0;

/// Scalar and axes that stand still while others move.
pub(super) fn check(draft: &Draft) -> Vec<Finding> {
    let sensors = [Column::Scalar, Column::FluxX, Column::FluxY, Column::FluxZ];
    let there: Vec<(Column, &[f64])> =
        sensors.into_iter().filter_map(|column| Some((column, draft.numbers(column)?))).collect();
    let mut findings = Vec::new();
    for (column, numbers) in &there {
        let Some((begin, end)) = longest_run(numbers).filter(|(begin, end)| end - begin >= ROWS) else { continue };
        let others = there.iter().filter(|(other, _)| other != column);
        let moves = others.into_iter().any(|(_, other)| {
            let inside = other[begin..end].iter().copied().filter(|value| value.is_finite());
            moments(inside).1 > MOVES_NT
        });
        if moves {
            let (seconds, from) = ((end - begin) as f64 * 0.1, draft.time_s[begin] - draft.time_s[0]);
            let text =
                format!("{} stands still for {seconds:.1} s from {from:.1} s on while the body moves", column.name());
            findings.push(Finding::warning(FindingKind::Stuck, text));
        }
    }
    findings
}

fn longest_run(numbers: &[f64]) -> Option<(usize, usize)> {
    let mut best = None;
    let mut begin = 0;
    for run in numbers.chunk_by(|a, b| a == b) {
        let end = begin + run.len();
        if best.is_none_or(|(from, to)| run.len() > to - from) {
            best = Some((begin, end));
        }
        begin = end;
    }
    best
}
