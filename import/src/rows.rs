//! The order of the rows: midnight, blocks of lines, single rows that stand wrong.

use crate::draft::Draft;
use crate::finding::Finding;
use crate::source::FindingKind;
use crate::stamp::DAY_S;
use crate::statistics::median;

/// A step back by a day, give or take this, is midnight, s.
const MIDNIGHT_TOLERANCE_S: f64 = 3600.0;
/// So many rows in a row make a block of their own; fewer are rows that stand wrong.
const SHORTEST_BLOCK: usize = 10;
/// A step forward of so many usual ones parts blocks.
const PAUSE_STEPS: f64 = 10.0;

/// Seconds beyond leave a double no room for milliseconds: no clock counts so far, and no grid of tenths can be laid there.
const LONGEST_S: f64 = 1e12;

/// What was done to the rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ordered {
    /// Rows without a place in time.
    pub left_out: usize,
    /// What was found.
    pub findings: Vec<Finding>,
}

/// Times that do not go back: midnight unwrapped, blocks sorted, what stands wrong made invalid, what has no time left out.
pub(crate) fn order(draft: &mut Draft) -> Ordered {
    let mut ordered = Ordered::default();
    let timed: Vec<usize> = (0..draft.len()).filter(|&row| draft.time_s[row].abs() < LONGEST_S).collect();
    ordered.left_out = draft.len() - timed.len();
    if ordered.left_out > 0 {
        draft.take(&timed);
        let text = format!("{} rows have no time that can be used and were left out", ordered.left_out);
        ordered.findings.push(Finding::warning(FindingKind::Order, text));
    }
    unwrap_midnight(draft, &mut ordered);
    sort_blocks(draft, &mut ordered);
    mend_single_rows(draft, &mut ordered);
    ordered
}

fn unwrap_midnight(draft: &mut Draft, ordered: &mut Ordered) {
    let (mut days, mut nights) = (0.0, 0);
    let mut before = f64::NEG_INFINITY;
    let has_day = draft.time_s.iter().any(|time_s| time_s.abs() > 10.0 * DAY_S);
    for time_s in &mut draft.time_s {
        let step_s = *time_s + days - before;
        // A date that stays while the clock begins anew is known by the same step.
        if (step_s + DAY_S).abs() < MIDNIGHT_TOLERANCE_S {
            days += DAY_S;
            nights += 1;
        } else if has_day && days > 0.0 && (step_s - DAY_S).abs() < MIDNIGHT_TOLERANCE_S {
            days -= DAY_S;
        }
        *time_s += days;
        before = *time_s;
    }
    if nights > 0 {
        ordered.findings.push(Finding::new(FindingKind::Order, "the clock passes midnight: the days were counted on"));
    }
}

/// Lines that stand in another order than they were sailed are sorted, if none overlaps another.
fn sort_blocks(draft: &mut Draft, ordered: &mut Ordered) {
    let times = &draft.time_s;
    let goes_back = |row: &usize| times[*row] < times[*row - 1] && stays_back(times, *row);
    if !(1..times.len()).any(|row| goes_back(&row)) {
        return;
    }
    // A line that follows another one without a step back may still stand days before it.
    let pause_s = PAUSE_STEPS * usual_step(times, &vec![false; times.len()]);
    let mut begins = vec![0];
    begins.extend((1..times.len()).filter(|row| goes_back(row) || times[*row] - times[*row - 1] > pause_s));
    let mut blocks: Vec<std::ops::Range<usize>> = begins
        .iter()
        .enumerate()
        .map(|(at, &begin)| begin..begins.get(at + 1).copied().unwrap_or(times.len()))
        .collect();
    // A few rows elsewhere, between two that follow each other, are no line.
    let is_spike = |three: &[std::ops::Range<usize>]| {
        let step_s = times[three[2].start] - times[three[0].end - 1];
        three[1].len() < SHORTEST_BLOCK && (0.0..=pause_s).contains(&step_s)
    };
    if blocks.windows(3).any(is_spike) {
        return;
    }
    blocks.sort_by(|a, b| times[a.start].total_cmp(&times[b.start]));
    let ends = |block: &std::ops::Range<usize>| times[block.clone()].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if blocks.windows(2).any(|pair| ends(&pair[0]) >= times[pair[1].start]) {
        return;
    }
    let rows: Vec<usize> = blocks.iter().cloned().flatten().collect();
    let text = format!("{} blocks of rows stand in another order than their times and were sorted", blocks.len());
    ordered.findings.push(Finding::new(FindingKind::Order, text));
    draft.take(&rows);
}

/// Whether the rows from here on stay before the one above: a block begins, not a single row that stands wrong.
fn stays_back(times: &[f64], row: usize) -> bool {
    let above = times[row - 1];
    times[row..].iter().take(SHORTEST_BLOCK).all(|time_s| *time_s < above)
}

/// A row whose time does not come after those before it: where there is room it gets the time in between and is invalid,
/// else it is left out. One that runs ahead of all that follow is such a row too.
fn mend_single_rows(draft: &mut Draft, ordered: &mut Ordered) {
    let times = &mut draft.time_s;
    if is_quantised(times) {
        return;
    }
    let mut wrong = vec![false; times.len()];
    let mut last = f64::NEG_INFINITY;
    for row in 0..times.len() {
        let ahead = times[row + 1..].iter().take(SHORTEST_BLOCK).filter(|later| **later <= times[row]).count();
        let following = (times.len() - row - 1).min(SHORTEST_BLOCK);
        let runs_ahead = following >= 3 && ahead * 10 >= following * 8;
        wrong[row] = times[row] <= last || runs_ahead;
        if !wrong[row] {
            last = times[row];
        }
    }
    let count = wrong.iter().filter(|wrong| **wrong).count();
    if count == 0 {
        return;
    }
    let usual_s = usual_step(times, &wrong);
    let mut keep = Vec::with_capacity(times.len());
    let mut row = 0;
    while row < times.len() {
        if !wrong[row] {
            keep.push(row);
            row += 1;
            continue;
        }
        let end = (row..times.len()).find(|&row| !wrong[row]).unwrap_or(times.len());
        place(times, row..end, usual_s, &mut draft.invalid, &mut keep);
        row = end;
    }
    let kept = keep.len();
    ordered.left_out += times.len() - kept;
    let first = wrong.iter().position(|wrong| *wrong).unwrap_or_default() + 1;
    let text = format!(
        "{count} rows have a time that repeats or goes back, the first is row {first}: {} were made invalid, {} repeat one and were left out",
        count - (times.len() - kept),
        times.len() - kept
    );
    ordered.findings.push(Finding::warning(FindingKind::Order, text));
    draft.take(&keep);
}

/// Rows that stand wrong get the times between their neighbours, where those are far enough apart.
fn place(times: &mut [f64], rows: std::ops::Range<usize>, usual_s: f64, invalid: &mut [bool], keep: &mut Vec<usize>) {
    let before = rows.start.checked_sub(1).map(|row| times[row]);
    let after = times.get(rows.end).copied();
    let (Some(before), Some(after)) = (before, after) else { return };
    let step_s = (after - before) / (rows.len() + 1) as f64;
    if step_s > 0.6 * usual_s {
        for (at, row) in rows.enumerate() {
            times[row] = before + step_s * (at + 1) as f64;
            invalid[row] = true;
            keep.push(row);
        }
    }
}

fn usual_step(times: &[f64], wrong: &[bool]) -> f64 {
    let good: Vec<f64> = times.iter().zip(wrong).filter(|(_, wrong)| !**wrong).map(|(time, _)| *time).collect();
    median(good.windows(2).map(|pair| pair[1] - pair[0]).collect()).unwrap_or(0.0)
}

/// Whether the stamps are coarser than the rows: then equal ones are no mistake.
pub(crate) fn is_quantised(times: &[f64]) -> bool {
    let equal = times.windows(2).filter(|pair| pair[1] == pair[0]).count();
    equal * 5 > times.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ordered(times: &[f64]) -> (Vec<f64>, Vec<bool>, usize) {
        let mut draft = Draft { time_s: times.to_vec(), invalid: vec![false; times.len()], ..Draft::default() };
        let ordered = order(&mut draft);
        (draft.time_s, draft.invalid, ordered.left_out)
    }

    fn steps(begin: f64, count: usize) -> impl Iterator<Item = f64> {
        (0..count).map(move |row| begin + row as f64 * 0.1)
    }

    #[test]
    fn midnight_goes_on() {
        let times: Vec<f64> = steps(86_399.0, 10).chain(steps(0.0, 20)).collect();
        let (times, ..) = ordered(&times);
        assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-6));
    }

    #[test]
    fn blocks_are_sorted_unless_they_overlap() {
        let times: Vec<f64> = steps(100.0, 20).chain(steps(0.0, 30)).chain(steps(50.0, 15)).collect();
        let (sorted, invalid, left_out) = ordered(&times);
        assert!(sorted.is_sorted() && sorted.len() == 65 && left_out == 0 && !invalid.contains(&true));
    }

    #[test]
    fn single_rows_are_invalid_or_left_out() {
        let mut times: Vec<f64> = steps(0.0, 40).collect();
        times[7] = 0.2;
        times[20] = 99.0;
        let (mended, invalid, left_out) = ordered(&times);
        assert_eq!((mended.len(), left_out), (40, 0));
        assert!((mended[7] - 0.7).abs() < 1e-9 && (mended[20] - 2.0).abs() < 1e-9);
        assert_eq!(invalid.iter().filter(|invalid| **invalid).count(), 2);
        let mut times: Vec<f64> = steps(0.0, 40).collect();
        times.insert(11, times[10]);
        times[25] = f64::NAN;
        times[30] = 1e15;
        let (mended, _, left_out) = ordered(&times);
        assert!(mended.len() == 38 && left_out == 3 && mended.windows(2).all(|pair| pair[1] > pair[0]));
    }
}
