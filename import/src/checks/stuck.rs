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

/// Smallest difference of readings of a scalar above which they may well stand still, as it reads the same on every heading, nT.
const COARSE_NT: f64 = 0.5;

/// Scalar and axes that stand still while others move.
pub(super) fn check(draft: &Draft) -> Vec<Finding> {
    let sentences = standing_still(&draft.time_s, |column| draft.numbers(column));
    sentences.into_iter().map(|text| Finding::warning(FindingKind::Stuck, text)).collect()
}

/// Of a recording at 10 Hz, scalar and axes that stand still while others move: a sentence each.
pub fn standing_still<'a>(time_s: &[f64], numbers: impl Fn(Column) -> Option<&'a [f64]>) -> Vec<String> {
    let sensors = [Column::Scalar, Column::FluxX, Column::FluxY, Column::FluxZ];
    let there: Vec<(Column, &[f64])> =
        sensors.into_iter().filter_map(|column| Some((column, numbers(column)?))).collect();
    let mut sentences = Vec::new();
    for (column, numbers) in there.iter().filter(|(column, numbers)| *column != Column::Scalar || !is_coarse(numbers)) {
        let Some((begin, end)) = longest_run(numbers).filter(|(begin, end)| end - begin >= ROWS) else { continue };
        let others = there.iter().filter(|(other, _)| other != column);
        let moves = others.into_iter().any(|(_, other)| {
            let inside = other[begin..end].iter().copied().filter(|value| value.is_finite());
            moments(inside).1 > MOVES_NT
        });
        if moves {
            let (seconds, from) = ((end - begin) as f64 * 0.1, time_s[begin] - time_s[0]);
            let name = column.name();
            sentences.push(format!("{name} stands still for {seconds:.1} s from {from:.1} s on while the body moves"));
        }
    }
    sentences
}

/// Whether neighbouring readings are the same or far apart: a recorder of such steps repeats itself.
fn is_coarse(numbers: &[f64]) -> bool {
    let differences = numbers.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|nt| *nt > 0.0);
    let least = differences.fold(f64::INFINITY, f64::min);
    least.is_finite() && least > COARSE_NT
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of a minute in which the fluxgate swings beside such a scalar and such an axis.
    fn said(scalar: impl Fn(usize) -> f64, axis: impl Fn(usize) -> f64) -> Vec<String> {
        let of = |value: &dyn Fn(usize) -> f64| (0..600).map(value).collect::<Vec<f64>>();
        let (time_s, scalar, axis) = (of(&|row| 0.1 * row as f64), of(&scalar), of(&axis));
        let swings = of(&|row| 30_000.0 + 500.0 * (0.2 * row as f64).sin());
        standing_still(&time_s, |column| match column {
            Column::Scalar => Some(&scalar[..]),
            Column::FluxX => Some(&axis[..]),
            _ => Some(&swings[..]),
        })
    }

    #[test]
    fn an_axis_that_is_not_connected_is_said_and_a_scalar_that_reads_whole_nanotesla_is_not() {
        let hums = |row: usize| 50_000.0 + 0.01 * (row * 7 % 11) as f64;
        let whole = |row: usize| 50_000.0 + f64::from(u8::from(row > 400));
        let moves = |row: usize| 20_000.0 + 3.0 * (row * 13 % 17) as f64;
        let stuck = said(hums, |_| 12.5);
        assert!(stuck.len() == 1 && stuck[0].starts_with("flux_x_nT stands still for 60.0 s"), "{stuck:?}");
        assert!(said(|_| 50_000.0, moves)[0].starts_with("scalar_nT stands still"));
        assert_eq!((said(whole, moves), said(hums, moves)), (Vec::new(), Vec::new()));
    }
}
